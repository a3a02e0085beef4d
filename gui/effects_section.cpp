#include "gui/effects_section.h"

#include "study/effects_study.h"

#include <QFrame>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QShowEvent>
#include <QVBoxLayout>

#include <algorithm>

namespace diatom::gui {

EffectsSection::EffectsSection(Session *session, QWidget *parent)
    : QWidget(parent), m_session(session), m_plan(this), m_measuring(this), m_intro(new QLabel(this)),
      m_measure(new QPushButton(this))
{
   setObjectName(QStringLiteral("effectsSection"));
   m_intro->setObjectName(QStringLiteral("effects.intro"));
   m_intro->setWordWrap(true);
   m_measure->setObjectName(QStringLiteral("effects.measure"));
   m_measure->setToolTip(tr("Time a step with each effect and without; takes some seconds"));
   connect(m_measure, &QPushButton::clicked, this, &EffectsSection::measure);
   auto *head = new QHBoxLayout;
   head->setContentsMargins(8, 8, 8, 4);
   head->addWidget(m_intro, 1);
   head->addWidget(m_measure, 0, Qt::AlignTop);
   auto *layout = new QVBoxLayout(this);
   layout->setContentsMargins(0, 0, 0, 0);
   layout->setSpacing(1);
   layout->addLayout(head);
   for (const std::string &name : effectNames()) {
      auto *row = new EffectEntry(name, this);
      m_rows.push_back(row);
      connect(row, &EffectEntry::clicked, this, [this, row] { choose(row == m_chosen ? nullptr : row); });
      connect(row, &EffectEntry::forced, this, [this, name](const QString &how) {
         m_session->run("effect", {{"effect", name}, {"forced", how.toStdString()}});
         refresh(); // a refused command leaves the switch as it was
      });
      layout->addWidget(row);
   }
   layout->addStretch();
   connect(session, &Session::designChanged, this, &EffectsSection::designChanged);
   refresh();
}

void EffectsSection::showEvent(QShowEvent *event)
{
   QWidget::showEvent(event);
   if (!event->spontaneous() && m_stale)
      replan();
}

void EffectsSection::hideEvent(QHideEvent *event)
{
   QWidget::hideEvent(event);
   if (event->spontaneous())
      return;
   if (m_plan.busy())
      m_stale = true;
   m_plan.cancel();
   m_measuring.cancel();
   choose(nullptr);
}

void EffectsSection::designChanged()
{
   m_stale = true;
   m_measuring.cancel();
   choose(nullptr);
   if (isVisible())
      replan();
}

void EffectsSection::replan()
{
   m_stale = false;
   const auto hierarchy = m_session->hierarchy();
   if (!hierarchy || hierarchy->cells() == 0) {
      m_plan.cancel();
      showEffects({});
      return;
   }
   auto effects = std::make_shared<std::vector<Effect>>();
   m_plan.start(
       [effects, hierarchy, setup = m_session->design().setup](const Job &job) {
          const Networks networks = findNetworks(*hierarchy, setup, job);
          if (!job.cancelled())
             *effects = planEffects(*hierarchy, setup, networks);
       },
       [this, effects] { showEffects(std::move(*effects)); });
}

void EffectsSection::showEffects(std::vector<Effect> effects)
{
   m_effects = std::move(effects);
   refresh();
}

void EffectsSection::refresh()
{
   const Design &design = m_session->design();
   const bool measured = design.setup == m_measuredOn.setup && design.model == m_measuredOn.model;
   for (EffectEntry *row : m_rows) {
      const auto effect = std::find_if(m_effects.begin(), m_effects.end(),
                                       [&](const Effect &one) { return one.name == row->name(); });
      row->setVisible(effect != m_effects.end());
      if (effect == m_effects.end())
         continue;
      const auto forced = design.setup.effects.find(row->name());
      const auto cost = m_costs.find(row->name());
      row->setEffect(*effect,
                     forced == design.setup.effects.end() ? std::nullopt : std::optional(forced->second),
                     measured && cost != m_costs.end() ? std::optional(cost->second) : std::nullopt);
   }
   const auto on = std::count_if(m_effects.begin(), m_effects.end(), [](const Effect &e) { return e.on; });
   m_measure->setVisible(!m_effects.empty());
   m_measure->setText(m_measuring.busy() ? tr("Stop") : tr("Measure costs"));
   if (!m_session->hierarchy())
      m_intro->setText(tr("The design's lattice is not installed: what is simulated is not known."));
   else if (m_effects.empty())
      m_intro->setText(tr("Place some cells: the effects that they call for are listed here, with the "
                          "reason for each."));
   else
      m_intro->setText(
          tr("%1 of %2 effects are simulated; one that is off takes no time. Costs are per cell and step.")
              .arg(on)
              .arg(m_effects.size()));
}

void EffectsSection::choose(EffectEntry *row)
{
   if (!row && !m_chosen)
      return;
   m_chosen = row;
   for (EffectEntry *one : m_rows)
      one->setChosen(one == row);
   emit evidenceChosen(row ? row->evidence() : std::vector<Index>());
}

void EffectsSection::measure()
{
   if (m_measuring.busy()) {
      m_measuring.cancel();
      refresh();
      return;
   }
   auto found = std::make_shared<std::optional<Result<EffectsStudy>>>();
   const Design design = m_session->design();
   m_measuring.start([found, design, catalogue = m_session->catalogue()](
                         const Job &job) { found->emplace(studyEffectsOf(catalogue, design, {}, job)); },
                     [this, found, design] {
                        const auto &study = **found;
                        m_costs.clear();
                        m_measuredOn = design;
                        if (!study)
                           emit failed(QString::fromStdString(study.error().message));
                        else
                           for (const EffectRow &row : study->rows)
                              if (row.cost())
                                 m_costs[row.effect] = *row.cost();
                        refresh();
                     });
   refresh();
}

} // namespace diatom::gui
