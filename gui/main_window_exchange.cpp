// The window's dealings with files of other programs: exports, and meshes that become cells; and how the
// exported parts and struts look.
#include "gui/main_window.h"

#include "assembly/assemble.h"
#include "assembly/chosen_parts.h"
#include "gui/export_dialog.h"
#include "gui/import_dialog.h"
#include "render/surface.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QLocale>

#include <optional>

namespace diatom::gui {

namespace {

/// What an export came to.
struct Written
{
   std::vector<ExportedFile> files; // of geometry
   std::vector<std::string> notes;
};

Result<Written> writeAsAsked(const ExportRequest &request, const Catalogue &catalogue, const Design &design,
                             const Hierarchy &hierarchy, const Job &job)
{
   Written written;
   if (request.foreign) {
      const Status saved =
          writeForeign(design, hierarchy, *request.foreign, request.file, written.notes, job);
      if (!saved)
         return saved.error();
      return written;
   }
   std::shared_ptr<const PartMaker> maker;
   if (!request.parts.empty()) {
      auto made = chosenParts(catalogue, design.assembly, request.parts, design.model.lattice.id, job);
      if (!made)
         return made.error();
      maker = *std::move(made);
   }
   auto files = exportFiles(hierarchy, maker.get(), request.options, request.file, job);
   if (!files)
      return files.error();
   written.files = *std::move(files);
   return written;
}

QString countText(std::uint64_t count) { return QLocale().toString(static_cast<qulonglong>(count)); }

/// Where the surface touches itself; "" where it does not, or where nobody counted.
QString contactsText(const std::vector<ExportedFile> &files, GeometryFormat format)
{
   std::uint64_t edges = 0, corners = 0;
   for (const ExportedFile &file : files) {
      edges += file.edgeContacts.value_or(0);
      corners += file.vertexContacts.value_or(0);
   }
   if (edges + corners == 0)
      return {};
   const QString where =
       corners == 0 ? MainWindow::tr("It touches itself along %1 edges").arg(countText(edges))
       : edges == 0 ? MainWindow::tr("It touches itself at %1 corners").arg(countText(corners))
                    : MainWindow::tr("It touches itself along %1 edges and at %2 more corners")
                          .arg(countText(edges), countText(corners));
   return QLatin1Char(' ') +
          (format == GeometryFormat::stl
               ? MainWindow::tr("%1; programs that read STL part it there.").arg(where)
               : MainWindow::tr("%1; it is split there, so that each piece is closed.").arg(where));
}

QString sentence(const ExportRequest &request, const Written &written, std::uint64_t cells)
{
   const QString name = QString::fromStdString(request.file.filename().string());
   if (request.foreign) {
      QString text =
          MainWindow::tr("Wrote %1 for %2.").arg(name, QString::fromUtf8(request.foreign->program));
      for (const std::string &note : written.notes)
         text += QLatin1Char('\n') + QString::fromStdString(note);
      return text;
   }
   std::uint64_t triangles = 0, parts = 0, covered = 0, struts = 0;
   for (const ExportedFile &file : written.files) {
      triangles += file.triangles;
      parts += file.parts;
      covered += file.cells;
      struts += file.struts.struts;
   }
   QString text = written.files.size() == 1
                      ? MainWindow::tr("Wrote %1").arg(name)
                      : MainWindow::tr("Wrote %1 files beside %2").arg(written.files.size()).arg(name);
   if (parts > 0)
      text += MainWindow::tr(", %1 parts").arg(countText(parts));
   if (struts > 0 && !request.options.eachMaterial)
      text += MainWindow::tr(", %1 struts").arg(countText(struts));
   text +=
       triangles > 0 ? MainWindow::tr(" with %1 triangles.").arg(countText(triangles)) : QStringLiteral(".");
   if (parts > 0 && covered < cells)
      text +=
          QLatin1Char(' ') + MainWindow::tr("%1 cells belong to no part.").arg(countText(cells - covered));
   return text + contactsText(written.files, request.options.format);
}

/// Parts in full detail where there are few.
Result<render::Surface> surfaceFor(GeometryOptions::What what, const Catalogue &catalogue,
                                   const AssemblySetup &assembly, const Hierarchy &hierarchy, const Job &job)
{
   constexpr std::uint64_t kFewCells = 2000;
   GeometryOptions options;
   options.what = what;
   options.detail = hierarchy.cells() > kFewCells ? 0 : -1;
   std::shared_ptr<const PartMaker> maker;
   if (what == GeometryOptions::What::parts) {
      auto made = chosenParts(catalogue, assembly, "", hierarchy.lattice().spec().id, job);
      if (!made)
         return made.error();
      maker = *std::move(made);
   }
   return render::surfaceOf(hierarchy, maker.get(), options, job);
}

} // namespace

bool MainWindow::startTask(const QString &name, std::function<void(const Job &)> work,
                           std::function<void()> done)
{
   if (m_task->start(name, std::move(work), std::move(done)))
      return true;
   m_messages->showMessage(tr("Something is still being read or written; wait for it or cancel it."), true);
   return false;
}

void MainWindow::showFailure(const Error &error)
{
   if (error.code != ErrorCode::cancelled)
      m_messages->showMessage(QString::fromStdString(error.message), true);
}

void MainWindow::chooseExport()
{
   if (!m_session.hierarchy() || m_session.hierarchy()->cells() == 0) {
      m_messages->showMessage(tr("There are no cells to export; place some first."), true);
      return;
   }
   auto *dialog = new ExportDialog(m_session, lastFolder("export"), this);
   dialog->setAttribute(Qt::WA_DeleteOnClose);
   connect(dialog, &QDialog::accepted, this, [this, dialog] {
      if (const auto request = dialog->request())
         exportTo(*request);
   });
   dialog->open();
}

void MainWindow::exportTo(const ExportRequest &request)
{
   const QString file = QString::fromStdString(request.file.string());
   rememberFolder("export", file);
   auto result = std::make_shared<std::optional<Result<Written>>>();
   const auto hierarchy = m_session.hierarchy();
   startTask(
       tr("Writing %1").arg(QFileInfo(file).fileName()),
       [result, request, hierarchy, catalogue = m_session.catalogue(), design = m_session.design()](
           const Job &job) { result->emplace(writeAsAsked(request, *catalogue, design, *hierarchy, job)); },
       [this, result, request, cells = hierarchy->cells()] {
          const auto &written = result->value();
          if (written.ok())
             m_messages->showMessage(sentence(request, *written, cells), false);
          else
             showFailure(written.error());
       });
}

/// A mesh is looked at first, so that the dialog can say what it makes.
void MainWindow::openMesh(const std::filesystem::path &file)
{
   auto result = std::make_shared<std::optional<Result<MeshFacts>>>();
   const QString name = QString::fromStdString(file.filename().string());
   startTask(
       tr("Looking at %1").arg(name),
       [result, file](const Job &job) { result->emplace(lookAtMesh(file, job)); },
       [this, result, file, name] {
          if (!result->value().ok()) {
             showFailure(result->value().error());
             return;
          }
          auto *dialog = new ImportDialog(m_session.catalogue(), name, *result->value(), this);
          dialog->setAttribute(Qt::WA_DeleteOnClose);
          connect(dialog, &QDialog::accepted, this, [this, dialog, file] {
             if (dialog->request())
                fillMesh(file, *dialog->request());
          });
          dialog->open();
       });
}

void MainWindow::fillMesh(const std::filesystem::path &file, const ImportRequest &request)
{
   auto result = std::make_shared<std::optional<Result<Opened>>>();
   startTask(
       tr("Filling %1 with cells").arg(QString::fromStdString(file.filename().string())),
       [result, file, request](const Job &job) {
          result->emplace(importMesh(file, request.mesh, *request.lattice, job));
       },
       [this, result, file, agreed = m_session.revision()] { takeRead(*std::move(*result), file, agreed); });
}

void MainWindow::writeProgram(const std::string &machine)
{
   const auto hierarchy = m_session.hierarchy();
   if (!hierarchy || hierarchy->cells() == 0) {
      m_messages->showMessage(tr("There are no cells to assemble; place some first."), true);
      return;
   }
   AssemblySetup setup = m_session.design().assembly;
   if (setup.machine != machine)
      setup.machineValues.clear();
   setup.machine = machine;
   const auto made = Machine::make(*m_session.catalogue(), machine, setup.machineValues, Job());
   if (!made) {
      showFailure(made.error());
      return;
   }
   const QString suffix = QString::fromUtf8((*made)->description().suffix);
   auto *dialog =
       new QFileDialog(this, tr("Machine Program"), lastFolder("program"), tr("Programs (*.%1)").arg(suffix));
   dialog->setObjectName(QStringLiteral("programDialog"));
   dialog->setAttribute(Qt::WA_DeleteOnClose);
   dialog->setAcceptMode(QFileDialog::AcceptSave);
   dialog->setDefaultSuffix(suffix);
   connect(dialog, &QFileDialog::fileSelected, this, [this, setup, hierarchy](const QString &file) {
      rememberFolder("program", file);
      auto result = std::make_shared<std::optional<Result<Assembled>>>();
      startTask(
          tr("Planning %1").arg(QFileInfo(file).fileName()),
          [result, setup, hierarchy, file = file.toStdString(), catalogue = m_session.catalogue(),
           name = m_session.design().name](const Job &job) {
             result->emplace(assemble(*catalogue, setup, *hierarchy, name, file, job));
          },
          [this, result, file] {
             if (!result->value().ok())
                return showFailure(result->value().error());
             const Assembled &done = *result->value();
             const std::int64_t left = done.total - done.summary.placements;
             QString words = tr("%1: %2 parts placed, about %3 min.")
                                 .arg(QFileInfo(file).fileName())
                                 .arg(done.summary.placements)
                                 .arg(done.summary.seconds / 60, 0, 'f', 1);
             if (left > 0 && !done.plan.problems.empty())
                words += tr(" %1 cannot be placed: %2")
                             .arg(left)
                             .arg(QString::fromStdString(done.plan.problems.front().text));
             m_messages->showMessage(words, left > 0);
          });
   });
   dialog->open();
}

void MainWindow::showAs(GeometryOptions::What what)
{
   const auto hierarchy = m_session.hierarchy();
   if (!hierarchy)
      return;
   if (m_player.active()) {
      m_messages->showMessage(tr("A simulation shows cells; take it back to its start first."), true);
      return;
   }
   auto result = std::make_shared<std::optional<Result<render::Surface>>>();
   startTask(
       what == GeometryOptions::What::parts ? tr("Making parts") : tr("Making struts"),
       [result, what, hierarchy, catalogue = m_session.catalogue(), assembly = m_session.design().assembly](
           const Job &job) { result->emplace(surfaceFor(what, *catalogue, assembly, *hierarchy, job)); },
       [this, result, hierarchy] {
          if (!result->value().ok())
             showFailure(result->value().error());
          else if (hierarchy == m_session.hierarchy() && !m_player.active()) // else of a design before
             m_viewport->showSurface(std::make_shared<render::Surface>(std::move(**result).value()));
       });
}

} // namespace diatom::gui
