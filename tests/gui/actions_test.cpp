// The action table: complete, reachable, and undone by one undo each.
#include "studio.h"

#include <QDockWidget>
#include <QMenu>

#include <set>

using namespace diatom;
using namespace diatom::test;

class ActionsTest : public QObject
{
   Q_OBJECT

private slots:
   void everyActionHasNameTextTipAndPlaceInAMenu()
   {
      Studio studio;
      std::set<QString> ids, keys;
      std::set<QAction *> inMenus;
      for (const QMenu *menu : studio.window.findChildren<QMenu *>())
         for (QAction *action : menu->actions())
            inMenus.insert(action);
      for (const gui::ActionInfo &info : gui::actionTable()) {
         QAction *action = studio.action(info.id);
         QVERIFY2(action, info.id);
         QVERIFY2(ids.insert(action->objectName()).second, info.id);
         QVERIFY2(!action->text().isEmpty() && !action->toolTip().isEmpty(), info.id);
         QVERIFY2(inMenus.count(action), info.id);
         for (const QKeySequence &key : action->shortcuts())
            QVERIFY2(keys.insert(key.toString()).second, info.id);       // no key means two things
         QVERIFY2(!*info.key || !action->shortcut().isEmpty(), info.id); // the key's text was understood
      }
   }

   void everyControlHasANameForScreenReaders()
   {
      Studio studio;
      for (const QToolButton *button : studio.window.findChildren<QToolButton *>())
         if (button->isVisible())
            QVERIFY2(!button->accessibleName().isEmpty() || !button->text().isEmpty(),
                     qPrintable(button->objectName()));
      QVERIFY(!studio.view().accessibleName().isEmpty());
   }

   void everyEditingActionIsTakenBackByOneUndo()
   {
      Studio studio;
      QVERIFY(studio.ready());
      studio.click(*studio.view().screenPosBase({0, 0, 0}));
      QTRY_COMPARE(studio.cells(), std::uint64_t(1));
      int edits = 0;
      for (const gui::ActionInfo &info : gui::actionTable()) {
         if (!info.edits)
            continue;
         ++edits;
         // A region over the cell for those that want one, a hovered port for the one that acts there.
         if (std::string_view(info.id) == "edit.place") {
            studio.key(Qt::Key_Escape);
            studio.moveTo(*studio.view().screenPosBase({0, -2, 0}));
         } else {
            studio.drag(*studio.view().screenPosBase({-1, -1, 0}), *studio.view().screenPosBase({1, -1, 0}),
                        Qt::ShiftModifier);
            if (std::string_view(info.id) == "edit.eraseRegion") {
               studio.key(Qt::Key_Escape);
               studio.drag(*studio.view().screenPosBase({2, -1, 0}), *studio.view().screenPosBase({-1, 0, 0}),
                           Qt::ShiftModifier);
            }
         }
         const QString before = studio.window.session().stateHash();
         QVERIFY2(studio.action(info.id)->isEnabled(), info.id);
         const QKeySequence key = studio.action(info.id)->shortcut();
         studio.key(static_cast<Qt::Key>(key[0].key()), key[0].keyboardModifiers());
         QVERIFY2(studio.window.session().stateHash() != before, info.id);
         const QString after = studio.window.session().stateHash();
         studio.key(Qt::Key_Z, Qt::ControlModifier);
         QCOMPARE(studio.window.session().stateHash(), before);
         studio.key(Qt::Key_Y, Qt::ControlModifier);
         QCOMPARE(studio.window.session().stateHash(), after);
         studio.key(Qt::Key_Z, Qt::ControlModifier);
      }
      QVERIFY(edits >= 3);
   }

   void toolsEraseAndPaintAndPickByTheirKeys()
   {
      Studio studio;
      QVERIFY(studio.ready());
      studio.key(Qt::Key_2);
      const MaterialIndex second = studio.window.session().material();
      studio.click(*studio.view().screenPosBase({0, 0, 0}));
      QTRY_COMPARE(studio.cells(), std::uint64_t(1));
      studio.key(Qt::Key_3);
      const MaterialIndex third = studio.window.session().material();
      QVERIFY(third != second);
      studio.key(Qt::Key_G);
      studio.click(*studio.view().screenPos({0, 0, 0}));
      QTRY_COMPARE(studio.window.session().hierarchy()->at({0, 0, 0}).material, third);
      studio.key(Qt::Key_1);
      studio.key(Qt::Key_I);
      studio.click(*studio.view().screenPos({0, 0, 0}));
      QTRY_COMPARE(studio.window.session().material(), third);
      studio.key(Qt::Key_B);
      studio.click(*studio.view().screenPos({0, 0, 0}), Qt::ControlModifier); // the opposite of placing
      QTRY_COMPARE(studio.cells(), std::uint64_t(0));
   }

   void aFailedCommandSaysSoWithoutADialog()
   {
      Studio studio;
      QVERIFY(studio.ready());
      auto *messages = studio.window.findChild<gui::MessageBar *>("messageBar");
      studio.window.open("/nowhere/at-all.diatom");
      QTRY_VERIFY(messages->text().contains("at-all.diatom"));
      studio.view().setFocus();
      studio.key(Qt::Key_Escape);
      QTRY_VERIFY(!messages->isVisible());
   }

   void rightDragTurnsMiddleDragMovesWheelZooms()
   {
      Studio studio;
      QVERIFY(studio.ready());
      const render::Camera before = studio.view().camera();
      const QPointF a(300, 300), b(360, 330);
      studio.drag(a, b, {}, Qt::RightButton);
      QVERIFY((studio.view().camera().backward() - before.backward()).norm() > 0.1);
      const render::Camera turned = studio.view().camera();
      studio.drag(a, b, {}, Qt::MiddleButton);
      QCOMPARE((studio.view().camera().backward() - turned.backward()).norm(), 0.0);
      QVERIFY((studio.view().camera().target() - turned.target()).norm() > 0);
      const double distance = studio.view().camera().distance();
      studio.wheel(a, 1, {});
      QVERIFY(studio.view().camera().distance() < distance);
      studio.drag(a, a + QPointF(2, 1)); // under 4 pixels: a click, not a drag
      QTRY_COMPARE(studio.cells(), std::uint64_t(1));
   }
};

QTEST_MAIN(ActionsTest)
#include "actions_test.moc"
