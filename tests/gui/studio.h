// The studio's window under test, driven only by what a user can do: pointer, wheel and keys. The viewport's
// probe is read, never told anything.
#pragma once

#include "gui/main_window.h"
#include "support/support.h"

#include <QApplication>
#include <QCursor>
#include <QImage>
#include <QLabel>
#include <QMenuBar>
#include <QToolButton>
#include <QWheelEvent>
#include <QWindow>

namespace diatom::test {

class Studio
{
public:
   explicit Studio(std::shared_ptr<const Catalogue> plugins = catalogue())
       : window(std::move(plugins), nullptr)
   {
      QCursor::setPos(1590, 990); // clear of the window
      window.move(0, 0);
      window.show();
      window.activateWindow();
   }

   bool ready() { return QTest::qWaitForWindowActive(&window) && settle(); }
   /// Waits for a picture newer than now.
   bool settle()
   {
      const quint64 before = view().frameId();
      view().update();
      return QTest::qWaitFor([&] { return view().frameId() > before; });
   }

   gui::Viewport &view() { return *window.findChild<gui::Viewport *>(QStringLiteral("viewport")); }
   QString label(const char *name) { return window.findChild<QLabel *>(QString::fromUtf8(name))->text(); }
   QAction *action(const char *name) { return window.findChild<QAction *>(QString::fromUtf8(name)); }
   QImage picture() { return view().grabFramebuffer(); }
   std::uint64_t cells() { return window.session().hierarchy()->cells(); }

   QPoint inWindow(const QPointF &at) { return view().mapTo(&window, at.toPoint()); }
   void moveTo(const QPointF &at, Qt::KeyboardModifiers = {})
   {
      QTest::mouseMove(window.windowHandle(), inWindow(at));
   }
   void click(const QPointF &at, Qt::KeyboardModifiers keys = {}, Qt::MouseButton button = Qt::LeftButton)
   {
      moveTo(at);
      QTest::mouseClick(window.windowHandle(), button, keys, inWindow(at));
   }
   void drag(const QPointF &from, const QPointF &to, Qt::KeyboardModifiers keys = {},
             Qt::MouseButton button = Qt::LeftButton)
   {
      moveTo(from);
      QTest::mousePress(window.windowHandle(), button, keys, inWindow(from));
      for (int i = 1; i <= 8; ++i)
         moveTo(from + (to - from) * i / 8.0);
      QTest::mouseRelease(window.windowHandle(), button, keys, inWindow(to));
   }
   void key(Qt::Key code, Qt::KeyboardModifiers keys = {})
   {
      QTest::keyClick(window.windowHandle(), code, keys);
   }
   void wheel(const QPointF &at, int steps, Qt::KeyboardModifiers keys)
   {
      QWheelEvent event(at, view().mapToGlobal(at), QPoint(), QPoint(0, 120 * steps), Qt::NoButton, keys,
                        Qt::NoScrollPhase, false);
      QApplication::sendEvent(&view(), &event);
   }
   /// Off the view, so that nothing is hovered.
   void leave() { QTest::mouseMove(window.windowHandle(), QPoint(window.width() - 5, window.height() - 5)); }

   /// Opens menu after menu with the pointer and clicks the action.
   bool choose(std::initializer_list<const char *> menus, const char *name)
   {
      QWidget *bar = window.menuBar();
      for (const char *id : menus) {
         auto *menu = window.findChild<QMenu *>(QString::fromUtf8(id));
         if (!menu || !clickItem(bar, menu->menuAction()) ||
             !QTest::qWaitFor([&] { return menu->isVisible(); }))
            return false;
         bar = menu;
      }
      return clickItem(bar, action(name));
   }

   gui::MainWindow window;

private:
   static bool clickItem(QWidget *holder, QAction *item)
   {
      const auto *bar = qobject_cast<QMenuBar *>(holder);
      const auto *menu = qobject_cast<QMenu *>(holder);
      if (!item)
         return false;
      const QRect place = bar ? bar->actionGeometry(item) : menu->actionGeometry(item);
      QTest::mouseMove(holder, place.center());
      QTest::mouseClick(holder, Qt::LeftButton, {}, place.center());
      return true;
   }
};

} // namespace diatom::test
