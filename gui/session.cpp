#include "gui/session.h"

#include "document/missing_lattice.h"
#include "gui/default_design.h"

#include <QStringList>

namespace diatom::gui {

Session::Session(std::shared_ptr<const Catalogue> catalogue, QObject *parent)
    : QObject(parent), m_catalogue(std::move(catalogue))
{
   replace(defaultDesign(LatticeSpec{}.id));
}

QString Session::title() const
{
   if (!m_file.empty())
      return QString::fromStdString(m_file.filename().string());
   return design().name.empty() ? tr("Untitled") : QString::fromStdString(design().name);
}

QString Session::stateHash() const { return QString::fromStdString(design().hash().text()); }

void Session::setMaterial(MaterialIndex material)
{
   const auto &materials = *design().model.materials;
   if (material == m_material || material == 0 || material > materials.size() ||
       materials[material - 1].id.empty())
      return;
   m_material = material;
   emit materialChanged();
}

void Session::newDesign(const std::string &lattice)
{
   m_file.clear();
   replace(defaultDesign(lattice));
}

void Session::take(Opened opened, const std::filesystem::path &file)
{
   m_file = opened.format == "diatom" ? file : std::filesystem::path();
   replace(std::move(opened.design));
   QStringList notes;
   for (const std::string &note : opened.notes)
      notes.append(QString::fromStdString(note));
   if (!notes.isEmpty())
      emit noted(notes.join(QLatin1Char('\n')));
}

bool Session::save(const std::filesystem::path &file)
{
   const Job job;
   if (const Status status = saveDesign(design(), file, job); !status) {
      emit failed(QString::fromStdString(status.error().message));
      return false;
   }
   m_file = file;
   m_document->markSaved();
   emit fileChanged();
   return true;
}

bool Session::run(const char *command, const nlohmann::json &arguments)
{
   const QString fault = tryRun(command, arguments);
   if (!fault.isEmpty())
      emit failed(fault);
   return fault.isEmpty();
}

QString Session::tryRun(const char *command, const nlohmann::json &arguments)
{
   const Job job;
   if (const Status status = m_document->run(command, arguments, job); !status)
      return QString::fromStdString(status.error().message);
   refresh();
   return {};
}

void Session::undo()
{
   if (m_document->undo())
      refresh();
}

void Session::redo()
{
   if (m_document->redo())
      refresh();
}

void Session::replace(Design design)
{
   m_document = std::make_unique<Document>(m_catalogue, std::move(design));
   m_material = 0;
   const auto &materials = *m_document->design().model.materials;
   for (std::size_t i = 0; i < materials.size() && m_material == 0; ++i)
      if (!materials[i].id.empty())
         m_material = static_cast<MaterialIndex>(i + 1);
   refresh();
   emit designReplaced();
   emit materialChanged();
}

void Session::refresh()
{
   ++m_revision;
   auto hierarchy = m_document->hierarchy();
   if (hierarchy) {
      m_hierarchy = std::move(*hierarchy);
   } else {
      m_hierarchy.reset();
      const std::string missing = missingLattice(design(), *m_catalogue);
      emit failed(QString::fromStdString(missing.empty() ? hierarchy.error().message : missing));
   }
   emit designChanged();
}

} // namespace diatom::gui
