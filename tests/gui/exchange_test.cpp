// Files of other programs in the studio, by pointer and keys: exports of cells, parts and struts, meshes that
// become cells, and the view of parts and struts.
#include "studio.h"

#include "assembly/assemble.h"
#include "core/file.h"
#include "formats/mesh_facts.h"
#include "io/mesh_read.h"

#include <QComboBox>
#include <QFile>
#include <QFileDialog>
#include <QLineEdit>
#include <QMessageBox>
#include <QPushButton>
#include <QTimer>

#include "gui/export_dialog.h"
#include "gui/import_dialog.h"
#include "gui/reference_menu.h"

using namespace diatom;
using namespace diatom::test;

namespace {

class ExchangeStudio : public Studio
{
public:
   bool openSample(const char *name)
   {
      return choose({"menu.file", "menu.samples"}, (std::string("file.sample.") + name).c_str()) &&
             QTest::qWaitFor([&] { return window.windowTitle().contains(name) && !window.busy(); }, 20000);
   }
   /// Once it has kept the focus for a while: without a window manager the main window may take it back,
   /// late, when the menu closes.
   template<typename Dialog>
   Dialog *dialog()
   {
      Dialog *found = nullptr;
      int kept = 0;
      const auto settled = [&] {
         found = window.findChild<Dialog *>();
         if (!found || !found->isVisible())
            return false;
         if (QApplication::activeWindow() == found)
            return ++kept == 10;
         kept = 0;
         found->activateWindow();
         return false;
      };
      return QTest::qWaitFor(settled, 20000) ? found : nullptr;
   }
   /// By its key; nobody gives the window back its focus where there is no window manager.
   gui::ExportDialog *exportByKey()
   {
      window.activateWindow();
      if (!QTest::qWaitForWindowActive(&window))
         return nullptr;
      view().setFocus();
      key(Qt::Key_E, Qt::ControlModifier);
      return dialog<gui::ExportDialog>();
   }
   /// Picks an entry by keys, as far down as it is.
   void pick(const char *name, const QVariant &data)
   {
      auto *box = window.findChild<QComboBox *>(QString::fromUtf8(name));
      box->setFocus();
      QTest::keyClick(box, Qt::Key_Home);
      for (int i = box->findData(data); i > 0; --i)
         QTest::keyClick(box, Qt::Key_Down);
   }
   void type(const char *name, const QString &text)
   {
      auto *line = window.findChild<QLineEdit *>(QString::fromUtf8(name));
      line->setFocus();
      line->selectAll();
      QTest::keyClicks(line, text);
   }
   QPushButton *button(const char *name) { return window.findChild<QPushButton *>(QString::fromUtf8(name)); }
   void press(const char *name) { QTest::mouseClick(button(name), Qt::LeftButton); }
   QString message() { return window.findChild<gui::MessageBar *>("messageBar")->text(); }
   bool idle()
   {
      return QTest::qWaitFor([&] { return !window.busy() && !window.findChild<QDialog *>("exportDialog"); },
                             test::kPatience);
   }
};

} // namespace

class ExchangeTest : public QObject
{
   Q_OBJECT

private slots:
   void exportsCellsPartsAndStruts();
   void exportsForOtherPrograms();
   void theDialogSaysWhatIsWrong();
   void aMeshIsFilledWithCells();
   void aBadMeshSaysSo();
   void editsMadeWhileAFileIsReadAreNotLost();
   void aMachineProgramIsWritten();
   void partsAndStrutsAreShownUntilTheNextEdit();
   void aReferenceMeshIsShownHiddenAndRemoved();
   void aDesignOfAMissingLatticeIsToldAndKept();

private:
   QString file(const char *name) { return m_dir.filePath(QString::fromUtf8(name)); }
   QTemporaryDir m_dir;
};

/// What each file holds is read back with the reader of meshes.
void ExchangeTest::exportsCellsPartsAndStruts()
{
   if (!canReadMeshes())
      QSKIP("this build has no assimp");
   ExchangeStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.openSample("octahedral-truss"));
   struct Row
   {
      const char *what, *name, *words;
   };
   std::vector<double> volumes;
   for (const Row &row : {Row{"cells", "cells.3mf", "edges"},
                          Row{"parts:org.diatom_cad.parts.snap_voxel", "parts.glb", " parts "},
                          Row{"edges", "struts.ply", " struts "},
                          Row{"cells", "one.stl", "programs that read STL part it there"}})
   {
      QVERIFY(studio.choose({"menu.file"}, "file.export"));
      QVERIFY(studio.dialog<gui::ExportDialog>());
      studio.pick("export.what", row.what);
      studio.type("export.file", file(row.name));
      QVERIFY(studio.button("export.write")->isEnabled());
      studio.press("export.write");
      QVERIFY(studio.idle());
      QVERIFY2(studio.message().startsWith(QString("Wrote %1").arg(row.name)), qPrintable(studio.message()));
      QVERIFY2(studio.message().contains(row.words), qPrintable(studio.message()));
      const auto facts = lookAtMesh(file(row.name).toStdString(), Job());
      DIATOM_VERIFY_OK(facts);
      const double metres = facts->customaryUnit; // 3MF and glTF say theirs, others are in millimetres
      volumes.push_back(facts->volume * metres * metres * metres);
   }
   // Cells of this lattice share no space. Single precision in the files: less than a part in 10^5 is left.
   const auto &hierarchy = *studio.window.session().hierarchy();
   const double cells = static_cast<double>(hierarchy.cells()) * hierarchy.lattice().shape(0).volume;
   QVERIFY(std::abs(volumes[0] / cells - 1) < 1e-5);
   QVERIFY(std::abs(volumes[3] / cells - 1) < 1e-5);
   QVERIFY(volumes[1] > 0 && volumes[1] < cells);
   QVERIFY(volumes[2] > 0 && volumes[2] < cells);
}

void ExchangeTest::exportsForOtherPrograms()
{
   ExchangeStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.openSample("gripper"));
   const auto cells = studio.cells();
   for (const char *name : {"g.vox", "g.vxc"}) {
      QVERIFY(studio.exportByKey());
      studio.type("export.file", file(name));
      QVERIFY(!studio.window.findChild<QComboBox *>("export.what")->isEnabled()); // it holds cells only
      studio.press("export.write");
      QVERIFY(studio.idle());
      QVERIFY2(studio.message().startsWith(QString("Wrote %1 for ").arg(name)), qPrintable(studio.message()));
      const auto read = openDesign(file(name).toStdString(), Job());
      DIATOM_VERIFY_OK(read);
      QCOMPARE(read->design.model.root.cells.count(), cells);
   }
   // The suffix .json says no program: the format is picked, and the name follows.
   QVERIFY(studio.exportByKey());
   studio.type("export.file", file("g.stl"));
   auto *format = studio.window.findChild<QComboBox *>("export.format");
   format->setFocus();
   QTest::keyClick(format, Qt::Key_Home);
   while (!format->currentText().contains("AMOEBA"))
      QTest::keyClick(format, Qt::Key_Down);
   QCOMPARE(studio.window.findChild<QLineEdit *>("export.file")->text(), file("g.json"));
   studio.press("export.write");
   QVERIFY(studio.idle());
   const auto read = openDesign(file("g.json").toStdString(), Job());
   DIATOM_VERIFY_OK(read);
   QCOMPARE(read->format, std::string("amoeba"));
}

void ExchangeTest::theDialogSaysWhatIsWrong()
{
   ExchangeStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.choose({"menu.file"}, "file.export"));
   QTRY_VERIFY2(studio.message().contains("no cells to export"), qPrintable(studio.message()));
   QVERIFY(studio.openSample("octahedral-truss"));
   QVERIFY(studio.choose({"menu.file"}, "file.export"));
   auto *dialog = studio.dialog<gui::ExportDialog>();
   QVERIFY(dialog);
   const auto words = [&] { return studio.label("export.words"); };
   studio.type("export.file", file("x.obj"));
   studio.pick("export.what", "beams");
   QVERIFY2(words().contains("Only 3MF knows beams"), qPrintable(words()));
   QVERIFY(!studio.button("export.write")->isEnabled());
   studio.pick("export.what", "edges");
   studio.type("export.strutWidth", "thick");
   QVERIFY2(words().contains("\"thick\" is no width"), qPrintable(words()));
   QVERIFY(!studio.button("export.write")->isEnabled());
   // A width that cannot be made is found while it is made.
   studio.type("export.strutWidth", "1 m");
   studio.press("export.write");
   QVERIFY(studio.idle());
   QVERIFY2(!studio.message().startsWith("Wrote") && !studio.message().isEmpty(),
            qPrintable(studio.message()));
   QVERIFY(!QFile::exists(file("x.obj")));

   QVERIFY(studio.choose({"menu.file"}, "file.export"));
   QVERIFY(studio.dialog<gui::ExportDialog>());
   studio.type("export.file", file("no/such/folder.obj"));
   studio.press("export.write");
   QVERIFY(studio.idle());
   QVERIFY2(studio.message().contains("no/such/folder"), qPrintable(studio.message()));
}

/// A box of 30 x 20 x 10 without one triangle of its lid: cells inside by winding number, and it is said.
void ExchangeTest::aMeshIsFilledWithCells()
{
   if (!canReadMeshes())
      QSKIP("this build has no assimp");
   QByteArray text;
   for (int corner = 0; corner < 8; ++corner)
      text += QString("v %1 %2 %3\n")
                  .arg(corner & 4 ? 30 : 0)
                  .arg(corner & 2 ? 20 : 0)
                  .arg(corner & 1 ? 10 : 0)
                  .toUtf8();
   const int faces[6][4] = {{1, 2, 4, 3}, {5, 7, 8, 6}, {1, 5, 6, 2},
                            {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}};
   for (const auto &f : faces) {
      text += QString("f %1 %2 %3\n").arg(f[0]).arg(f[1]).arg(f[2]).toUtf8();
      if (&f != &faces[5])
         text += QString("f %1 %2 %3\n").arg(f[0]).arg(f[2]).arg(f[3]).toUtf8();
   }
   QFile mesh(file("box.obj"));
   QVERIFY(mesh.open(QIODevice::WriteOnly));
   QVERIFY(mesh.write(text) == text.size());
   mesh.close();

   ExchangeStudio studio;
   QVERIFY(studio.ready());
   studio.window.open(file("box.obj").toStdString());
   auto *dialog = studio.dialog<gui::ImportDialog>();
   QVERIFY(dialog);
   QVERIFY2(studio.label("import.mesh").contains("open"), qPrintable(studio.label("import.mesh")));
   QCOMPARE(studio.label("import.size"), QString("30 mm x 20 mm x 10 mm"));
   const auto about = [&] { return studio.label("import.about"); };
   studio.type("import.pitch", "wide");
   QVERIFY2(about().contains("\"wide\" is no pitch"), qPrintable(about()));
   QVERIFY(!studio.button("import.fill")->isEnabled());
   studio.type("import.pitch", "1 m");
   QVERIFY2(about().contains("Choose a smaller pitch"), qPrintable(about()));
   studio.type("import.pitch", "2 in");
   studio.pick("import.unit", 25.4e-3);
   QCOMPARE(studio.label("import.size"), QString("762 mm x 508 mm x 254 mm"));
   // 15 x 10 x 5 cells fit; what the hole takes from the volume is told as it is estimated.
   const auto number = about().remove(QRegularExpression("[^0-9]")).toInt();
   QVERIFY2(std::abs(number / 750.0 - 1) < 0.1, qPrintable(about()));
   studio.type("import.material", "clay");
   QVERIFY(studio.button("import.fill")->isEnabled());
   studio.press("import.fill");
   QTRY_VERIFY_WITH_TIMEOUT(!studio.window.busy() && studio.window.windowTitle().contains("box"),
                            test::kPatience);
   QCOMPARE(studio.cells(), std::uint64_t(750));
   QCOMPARE(studio.window.session().design().model.lattice.pitch, 2 * 25.4e-3);
   QCOMPARE((*studio.window.session().design().model.materials)[0].id, std::string("clay"));
   QVERIFY(studio.window.session().file().empty());
   QVERIFY2(studio.message().contains("open edges"), qPrintable(studio.message()));
}

void ExchangeTest::aBadMeshSaysSo()
{
   QFile mesh(file("bad.stl"));
   QVERIFY(mesh.open(QIODevice::WriteOnly));
   mesh.write("this is no mesh at all");
   mesh.close();
   ExchangeStudio studio;
   QVERIFY(studio.ready());
   const QString before = studio.window.session().stateHash();
   studio.window.open(file("bad.stl").toStdString());
   QTRY_VERIFY_WITH_TIMEOUT(studio.message().contains("bad.stl"), 20000);
   QVERIFY(!studio.window.findChild<gui::ImportDialog *>());
   QCOMPARE(studio.window.session().stateHash(), before);
}

void ExchangeTest::partsAndStrutsAreShownUntilTheNextEdit()
{
   ExchangeStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.openSample("octahedral-truss"));
   studio.leave();
   QVERIFY(studio.settle());
   const QImage cells = studio.picture();
   studio.view().setFocus();
   studio.key(Qt::Key_P);
   QTRY_VERIFY_WITH_TIMEOUT(studio.view().scene().surface(), test::kPatience);
   QVERIFY(studio.settle());
   const QImage parts = studio.picture();
   QVERIFY(parts != cells);
   QVERIFY(studio.choose({"menu.view"}, "view.struts"));
   const auto before = studio.view().scene().surface();
   QTRY_VERIFY_WITH_TIMEOUT(studio.view().scene().surface() != before, test::kPatience);
   studio.leave();
   QVERIFY(studio.settle());
   QVERIFY(studio.picture() != parts && studio.picture() != cells);
   studio.view().setFocus();
   studio.key(Qt::Key_V);
   QVERIFY(!studio.view().scene().surface());
   QVERIFY(studio.settle());
   QVERIFY(studio.picture() == cells);

   // An edit drops them.
   studio.key(Qt::Key_P);
   QTRY_VERIFY_WITH_TIMEOUT(studio.view().scene().surface(), test::kPatience);
   QVERIFY(studio.window.session().run("set-material", {{"id", "other"}}));
   QVERIFY(!studio.view().scene().surface());

   // A lattice of which nobody makes parts.
   studio.window.session().newDesign("org.diatom_cad.lattice.honeycomb");
   studio.view().setFocus();
   studio.key(Qt::Key_P);
   QTRY_VERIFY2(studio.message().contains("makes parts for the lattice"), qPrintable(studio.message()));
   QVERIFY(!studio.view().scene().surface());
}

void ExchangeTest::aReferenceMeshIsShownHiddenAndRemoved()
{
   if (!canReadMeshes())
      QSKIP("this build has no assimp");
   QFile mesh(file("roof.obj")); // a triangle over the truss, 0.1 m wide
   QVERIFY(mesh.open(QIODevice::WriteOnly));
   mesh.write("v 0 0 60\nv 100 0 60\nv 0 100 60\nf 1 2 3\n");
   mesh.close();
   ExchangeStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.openSample("octahedral-truss"));
   studio.leave();
   QVERIFY(studio.settle());
   const QImage without = studio.picture();
   auto *menu = studio.window.findChild<gui::ReferenceMenu *>("menu.references");
   QVERIFY(menu);
   const auto read = [&] {
      return QTest::qWaitFor([&] { return !menu->busy(); }, test::kPatience) && studio.settle();
   };
   menu->add(file("roof.obj").toStdString()); // what the file dialog gives
   QVERIFY(read());
   const auto &references = studio.window.session().design().referenceMeshes;
   QCOMPARE(references.size(), std::size_t(1));
   QCOMPARE(references[0].name, std::string("roof"));
   QVERIFY(studio.picture() != without);
   const QImage with = studio.picture();

   const auto entry = [&](const QString &text) {
      for (QAction *action : menu->actions())
         if (action->text() == text)
            return action;
      return static_cast<QAction *>(nullptr);
   };
   QVERIFY(entry("roof") && entry("roof")->isChecked());
   entry("roof")->trigger();
   QVERIFY(read());
   QVERIFY(studio.picture() == without);
   studio.window.session().undo();
   QVERIFY(read());
   QVERIFY(studio.picture() == with);
   QVERIFY(entry("Remove roof"));
   entry("Remove roof")->trigger();
   QVERIFY(read());
   QVERIFY(studio.picture() == without);
   QVERIFY(!entry("roof"));

   // One that is gone is told, and stays in the design.
   menu->add(file("gone.obj").toStdString());
   QVERIFY(read());
   QVERIFY2(studio.message().contains("gone.obj"), qPrintable(studio.message()));
   QCOMPARE(studio.window.session().design().referenceMeshes.size(), std::size_t(1));
}

void ExchangeTest::aDesignOfAMissingLatticeIsToldAndKept()
{
   QFile document(file("quasi.diatom"));
   QVERIFY(document.open(QIODevice::WriteOnly));
   document.write(R"({"diatom": 1, "name": "quasi", "lattice": {"id": "org.nobody.lattice.quasi"},
      "materials": [{"id": "a"}], "assembly": {"cells": [["a", [0, 0, 0], [3, 2, 1]]]}})");
   document.close();
   ExchangeStudio studio;
   QVERIFY(studio.ready());
   studio.window.open(file("quasi.diatom").toStdString());
   QTRY_VERIFY_WITH_TIMEOUT(!studio.window.busy() && studio.window.windowTitle().contains("quasi"), 20000);
   QVERIFY2(studio.message().contains("org.nobody.lattice.quasi is not installed: the 6 stored cells"),
            qPrintable(studio.message()));
   const QString hash = studio.window.session().stateHash();
   QVERIFY(studio.settle()); // nothing to draw, and nothing breaks
   studio.view().setFocus();
   studio.key(Qt::Key_P);
   studio.key(Qt::Key_Space);
   QVERIFY(studio.window.session().save(file("again.diatom").toStdString()));
   studio.window.open(file("again.diatom").toStdString());
   QTRY_VERIFY_WITH_TIMEOUT(!studio.window.busy() && studio.window.windowTitle().contains("again"), 20000);
   QCOMPARE(studio.window.session().stateHash(), hash);
}

void ExchangeTest::editsMadeWhileAFileIsReadAreNotLost()
{
   ExchangeStudio studio;
   QVERIFY(studio.ready());
   const auto sample = test::samplesDir() / "gripper.diatom";
   studio.window.open(sample); // read in a thread; its end comes through the event loop
   QVERIFY(studio.window.session().run("set-name", {{"name", "edited meanwhile"}}));
   const QString edited = studio.window.session().stateHash();
   const auto answer = [&](QMessageBox::StandardButton button) {
      int asked = 0;
      QTimer look;
      connect(&look, &QTimer::timeout, this, [&] {
         if (auto *box = qobject_cast<QMessageBox *>(QApplication::activeModalWidget())) {
            ++asked;
            QTest::mouseClick(box->button(button), Qt::LeftButton);
         }
      });
      look.start(20);
      return QTest::qWaitFor([&] { return asked > 0 && !studio.window.busy(); }, 20000) && asked == 1;
   };
   QVERIFY(answer(QMessageBox::Cancel));
   QCOMPARE(studio.window.session().stateHash(), edited);
   studio.window.open(sample);
   QVERIFY(studio.window.session().run("set-name", {{"name", "and again"}}));
   QVERIFY(answer(QMessageBox::Discard));
   QVERIFY(studio.window.windowTitle().contains("gripper"));
}

void ExchangeTest::aMachineProgramIsWritten()
{
   ExchangeStudio studio;
   QVERIFY(studio.ready());
   QVERIFY(studio.openSample("capacitor-tower"));
   const std::string machine = "org.diatom_cad.machine.gcode";
   QVERIFY(studio.choose({"menu.file", "menu.machines"}, ("file.machine." + machine).c_str()));
   auto *dialog = studio.dialog<QFileDialog>();
   QVERIFY(dialog);
   const QTemporaryDir dir;
   auto *line = dialog->findChild<QLineEdit *>("fileNameEdit");
   line->setCompleter(
       nullptr); // its list opens when the folder has been read, early or late, and takes Return
   line->setFocus();
   line->selectAll();
   QTest::keyClicks(line, dir.filePath("tower")); // the suffix is the machine's
   QTest::keyClick(line, Qt::Key_Return);
   const QString file = dir.filePath("tower.ngc");
   QVERIFY(QTest::qWaitFor([&] { return QFile::exists(file) && !studio.window.busy(); }, test::kPatience));
   QVERIFY2(studio.message().startsWith("tower.ngc: "), qPrintable(studio.message()));
   QVERIFY2(studio.message().contains("parts placed, about"), qPrintable(studio.message()));
   // The bytes that the command line writes.
   gui::Session &session = studio.window.session();
   AssemblySetup setup = session.design().assembly;
   setup.machine = machine;
   const std::string again = dir.filePath("again.ngc").toStdString();
   DIATOM_VERIFY_OK(
       assemble(*session.catalogue(), setup, *session.hierarchy(), session.design().name, again, Job()));
   const auto written = readFile(file.toStdString()), expected = readFile(again);
   DIATOM_VERIFY_OK(written);
   DIATOM_VERIFY_OK(expected);
   QVERIFY(expected->size() > 1000 && *written == *expected);
}

QTEST_MAIN(ExchangeTest)
#include "exchange_test.moc"
