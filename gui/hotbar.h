// The materials of the design as numbered buttons; keys 1 to 9 take one in hand.
#pragma once

#include "gui/session.h"

#include <QWidget>

class QVBoxLayout;

namespace diatom::gui {

class Hotbar : public QWidget
{
   Q_OBJECT

public:
   explicit Hotbar(Session *session, QWidget *parent = nullptr);

private:
   void rebuild();
   void mark();

   Session *m_session;
   QVBoxLayout *m_layout;
   std::shared_ptr<const std::vector<Material>> m_shown;
};

} // namespace diatom::gui
