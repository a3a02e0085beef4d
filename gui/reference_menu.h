// File > Reference Meshes: adds, shows, hides and removes the meshes that a design is shown against, and
// hands those that are shown to the viewport.
#pragma once

#include "gui/background.h"
#include "gui/session.h"
#include "gui/viewport.h"

#include <QMenu>

namespace diatom::gui {

class ReferenceMenu : public QMenu
{
   Q_OBJECT

public:
   ReferenceMenu(Session *session, Viewport *viewport, QWidget *parent);

   /// Adds a mesh, by a name of its own.
   void add(const std::filesystem::path &file);
   /// Whether meshes are being read.
   bool busy() const { return m_reading.busy(); }

signals:
   void noted(const QString &message);

private:
   void choose();
   void rebuild();
   void designChanged();

   Session *m_session;
   Viewport *m_viewport;
   Background m_reading;
   std::vector<ReferenceMesh> m_drawn; // what the viewport has, or will have
};

} // namespace diatom::gui
