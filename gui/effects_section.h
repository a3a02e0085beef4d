// Which effects the open design calls for and why, with a switch for each: planned in the background anew
// after each edit while it is seen.
#pragma once

#include "gui/background.h"
#include "gui/effect_entry.h"
#include "gui/session.h"

#include <QWidget>

#include <map>
#include <vector>

class QLabel;
class QPushButton;

namespace diatom::gui {

class EffectsSection : public QWidget
{
   Q_OBJECT

public:
   EffectsSection(Session *session, QWidget *parent);

   /// Whether what is shown is of the design as it is now.
   bool current() const { return !m_stale && !m_plan.busy(); }

signals:
   /// Cells to point out in the view; none = no more.
   void evidenceChosen(const std::vector<Index> &cells);
   void failed(const QString &message);

protected:
   void showEvent(QShowEvent *event) override;
   void hideEvent(QHideEvent *event) override;

private:
   void designChanged();
   void replan();
   void showEffects(std::vector<Effect> effects);
   void refresh();
   void choose(EffectEntry *row);
   void measure();

   Session *m_session;
   Background m_plan, m_measuring;
   QLabel *m_intro;
   QPushButton *m_measure;
   std::vector<EffectEntry *> m_rows;
   EffectEntry *m_chosen = nullptr;
   std::vector<Effect> m_effects;
   std::map<std::string, double> m_costs; // ns per cell and step, measured on this very design
   Design m_measuredOn;
   bool m_stale = true;
};

} // namespace diatom::gui
