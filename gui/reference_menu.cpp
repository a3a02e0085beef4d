#include "gui/reference_menu.h"

#include "formats/reference_meshes.h"
#include "render/surface.h"

#include <QFileDialog>

#include <algorithm>
#include <optional>

namespace diatom::gui {

ReferenceMenu::ReferenceMenu(Session *session, Viewport *viewport, QWidget *parent)
    : QMenu(tr("&Reference Meshes"), parent), m_session(session), m_viewport(viewport), m_reading(this)
{
   setObjectName(QStringLiteral("menu.references"));
   connect(session, &Session::designChanged, this, &ReferenceMenu::designChanged);
   rebuild();
}

void ReferenceMenu::rebuild()
{
   clear();
   QAction *add = addAction(tr("&Add..."), this, &ReferenceMenu::choose);
   add->setObjectName(QStringLiteral("file.reference.add"));
   add->setToolTip(tr("Show a mesh beside the cells, to design against"));
   const auto &references = m_session->design().referenceMeshes;
   if (references.empty())
      return;
   addSeparator();
   for (const ReferenceMesh &reference : references) {
      QAction *shown = addAction(QString::fromStdString(reference.name));
      shown->setCheckable(true);
      shown->setChecked(reference.shown);
      shown->setToolTip(tr("Show or hide %1").arg(shown->text()));
      connect(shown, &QAction::triggered, this, [this, name = reference.name](bool on) {
         m_session->run("reference-mesh", {{"name", name}, {"shown", on}});
      });
   }
   addSeparator();
   for (const ReferenceMesh &reference : references)
      addAction(tr("Remove %1").arg(QString::fromStdString(reference.name)), this,
                [this, name = reference.name] {
                   m_session->run("remove-reference-mesh", {{"name", name}});
                });
}

void ReferenceMenu::choose()
{
   const QString file =
       QFileDialog::getOpenFileName(parentWidget(), tr("Reference Mesh"), QString(),
                                    tr("Meshes (*.stl *.obj *.ply *.3mf *.gltf *.glb);;All files (*)"));
   if (!file.isEmpty())
      add(file.toStdString());
}

void ReferenceMenu::add(const std::filesystem::path &file)
{
   const auto &known = m_session->design().referenceMeshes;
   const std::string stem = file.stem().string();
   std::string name = stem;
   for (int k = 2;
        std::any_of(known.begin(), known.end(), [&](const ReferenceMesh &one) { return one.name == name; });
        ++k)
      name = stem + " " + std::to_string(k);
   m_session->run("reference-mesh", {{"name", name}, {"file", file.string()}});
}

void ReferenceMenu::designChanged()
{
   if (m_session->design().referenceMeshes == m_drawn)
      return;
   m_drawn = m_session->design().referenceMeshes;
   rebuild();
   struct Read
   {
      LoadedReferences loaded;
      std::shared_ptr<const render::Surface> surface;
   };
   auto read = std::make_shared<Read>();
   m_reading.start(
       [read, references = m_drawn](const Job &job) {
          if (auto loaded = loadReferenceMeshes(references, job)) {
             read->loaded = *std::move(loaded);
             read->surface = std::make_shared<render::Surface>(render::surfaceOf(read->loaded.meshes));
          }
       },
       [this, read] {
          m_viewport->showReferences(read->surface);
          for (const std::string &note : read->loaded.notes)
             emit noted(QString::fromStdString(note));
       });
}

} // namespace diatom::gui
