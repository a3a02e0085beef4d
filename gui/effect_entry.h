// One effect: whether it is simulated and why, what it costs, the switch that forces it, and the cells that
// show it.
#pragma once

#include "scene/effects.h"

#include <QFrame>

class QComboBox;
class QLabel;
class QToolButton;

namespace diatom::gui {

class EffectEntry : public QFrame
{
   Q_OBJECT

public:
   EffectEntry(const std::string &name, QWidget *parent);

   const std::string &name() const { return m_name; }
   /// `forced`: as the design has it, nothing = auto. `cost`: ns per cell and step, nothing = not known.
   void setEffect(const Effect &effect, std::optional<bool> forced, std::optional<double> cost);
   void setChosen(bool chosen);
   const std::vector<Index> &evidence() const { return m_evidence; }

signals:
   void forced(const QString &how); // "auto", "on", "off"
   void clicked();

protected:
   void mouseReleaseEvent(QMouseEvent *event) override;

private:
   std::string m_name;
   std::vector<Index> m_evidence;
   QLabel *m_state, *m_why, *m_cost;
   QComboBox *m_switch;
   QToolButton *m_cells;
};

} // namespace diatom::gui
