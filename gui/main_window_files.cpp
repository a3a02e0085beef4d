// The window's dealings with files, and its help.
#include "gui/main_window.h"

#include "io/mesh_read.h"

#include <QCoreApplication>
#include <QDialog>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QHeaderView>
#include <QMessageBox>
#include <QTableWidget>
#include <QVBoxLayout>

#include <optional>

namespace diatom::gui {

std::vector<std::filesystem::path> MainWindow::sampleFolders()
{
   const std::filesystem::path bin = QCoreApplication::applicationDirPath().toStdString();
   std::vector<std::filesystem::path> folders;
   if (qEnvironmentVariableIsSet("DIATOM_SOURCE_DIR"))
      folders.emplace_back(std::filesystem::path(qgetenv("DIATOM_SOURCE_DIR").toStdString()) / "resources" /
                           "samples");
   folders.push_back(bin / ".." / "share" / "diatom" / "samples");
   folders.push_back(bin / ".." / ".." / ".." / "resources" /
                     "samples"); // build/<preset>/bin in a source tree
   return folders;
}

QString MainWindow::lastFolder(const char *purpose) const
{
   QString remembered =
       m_settings ? m_settings->value(QStringLiteral("folder/%1").arg(QString::fromUtf8(purpose))).toString()
                  : QString();
   if (!remembered.isEmpty())
      return remembered;
   return m_session.file().empty() ? QDir::homePath()
                                   : QString::fromStdString(m_session.file().parent_path().string());
}

void MainWindow::rememberFolder(const char *purpose, const QString &file)
{
   if (m_settings)
      m_settings->setValue(QStringLiteral("folder/%1").arg(QString::fromUtf8(purpose)),
                           QFileInfo(file).path());
}

bool MainWindow::mayDiscard()
{
   if (!m_session.modified())
      return true;
   const auto answer = QMessageBox::question(this, tr("Unsaved changes"),
                                             tr("Save the changes to %1?").arg(m_session.title()),
                                             QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel);
   return answer == QMessageBox::Discard || (answer == QMessageBox::Save && save(false));
}

void MainWindow::open(const std::filesystem::path &file)
{
   if (isMeshFile(file)) {
      openMesh(file);
      return;
   }
   auto result = std::make_shared<std::optional<Result<Opened>>>();
   startTask(
       tr("Opening %1").arg(QString::fromStdString(file.filename().string())),
       [result, file](const Job &job) { result->emplace(openDesign(file, job)); },
       [this, result, file, agreed = m_session.revision()] { takeRead(*std::move(*result), file, agreed); });
}

void MainWindow::takeRead(Result<Opened> read, const std::filesystem::path &file, std::uint64_t agreed)
{
   if (!read)
      showFailure(read.error());
   else if (m_session.revision() == agreed || mayDiscard())
      m_session.take(*std::move(read), file);
}

void MainWindow::chooseAndOpen()
{
   if (!mayDiscard())
      return;
   const QString file = QFileDialog::getOpenFileName(
       this, tr("Open"), lastFolder("design"),
       tr("Designs and meshes (*.diatom *.json *.vox *.vxc *.vxa *.stl *.obj "
          "*.ply *.3mf *.gltf *.glb);;Designs (*.diatom *.json *.vox *.vxc "
          "*.vxa);;Meshes (*.stl *.obj *.ply *.3mf *.gltf *.glb);;All files (*)"));
   if (file.isEmpty())
      return;
   rememberFolder("design", file);
   open(file.toStdString());
}

bool MainWindow::save(bool elsewhere)
{
   std::filesystem::path file = m_session.file();
   if (elsewhere || file.empty()) {
      QString chosen =
          QFileDialog::getSaveFileName(this, tr("Save"), lastFolder("design"), tr("Diatom (*.diatom)"));
      if (chosen.isEmpty())
         return false;
      if (QFileInfo(chosen).suffix().isEmpty())
         chosen += QStringLiteral(".diatom");
      rememberFolder("design", chosen);
      file = chosen.toStdString();
   }
   return m_session.save(file);
}

void MainWindow::showKeys()
{
   auto *dialog = new QDialog(this);
   dialog->setObjectName(QStringLiteral("keySheet"));
   dialog->setAttribute(Qt::WA_DeleteOnClose);
   dialog->setWindowTitle(tr("Keys and mouse"));
   const std::pair<QString, QString> mouse[] = {
       {tr("Left click"), tr("Use the tool")},
       {tr("Ctrl + left click"), tr("The opposite of the tool: erase instead of place")},
       {tr("Alt + left click"), tr("Take the material under the pointer in hand")},
       {tr("Shift + left drag"), tr("Region; drag its arrow or press Up and Down for the height")},
       {tr("Right drag"), tr("Turn the view about the cell under the pointer")},
       {tr("Middle drag, Space + left drag"), tr("Move the view")},
       {tr("Wheel"), tr("Zoom to the pointer")},
       {tr("Alt + wheel"), tr("Go through the cell's ports, hidden ones included")},
       {tr("1 to 9"), tr("Take a material in hand")}};
   auto *table = new QTableWidget(0, 2, dialog);
   table->setHorizontalHeaderLabels({tr("Input"), tr("Does")});
   table->verticalHeader()->hide();
   table->setEditTriggers(QAbstractItemView::NoEditTriggers);
   const auto add = [table](const QString &input, const QString &does) {
      const int row = table->rowCount();
      table->insertRow(row);
      table->setItem(row, 0, new QTableWidgetItem(input));
      table->setItem(row, 1, new QTableWidgetItem(does));
   };
   for (const auto &[input, does] : mouse)
      add(input, does);
   for (const ActionInfo &info : actionTable())
      if (*info.key)
         add(m_actions[info.id]->shortcut().toString(QKeySequence::NativeText),
             QCoreApplication::translate("Actions", info.tip));
   table->resizeColumnsToContents();
   table->horizontalHeader()->setStretchLastSection(true);
   auto *layout = new QVBoxLayout(dialog);
   layout->addWidget(table);
   dialog->resize(720, 620);
   dialog->show();
}

void MainWindow::showAbout()
{
   m_messages->showMessage(
       tr("Diatom %1: design, simulate and assemble digital materials. Apache licence 2.0. Drawing with %2.")
           .arg(QCoreApplication::applicationVersion(), m_viewport->device()),
       false);
}

} // namespace diatom::gui
