#include "gui/accuracy_section.h"

#include "gui/readable.h"
#include "gui/run_account.h"
#include "gui/solver_values.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QShowEvent>
#include <QToolButton>
#include <QVBoxLayout>

#include <cmath>

namespace diatom::gui {

namespace {

constexpr int kIdle = 500; // ms without an edit before a probe begins

QLabel *words(const char *name, QWidget *parent)
{
   auto *label = new QLabel(parent);
   label->setObjectName(QString::fromUtf8(name));
   label->setWordWrap(true);
   label->setTextFormat(Qt::PlainText);
   return label;
}

} // namespace

AccuracySection::AccuracySection(Session *session, SimulationPlayer *player, QWidget *parent)
    : QWidget(parent), m_session(session), m_player(player), m_probing(this), m_choosing(this),
      m_status(words("accuracy.status", this)), m_answerLabel(words("accuracy.answer", this)),
      m_limit(words("accuracy.limit", this)),
      m_ask(new ValueField(
          tr("Accuracy, percent"), [this](const QString &text) { return ask(text); }, this)),
      m_pick(new QPushButton(this)), m_table(new AccuracyTable(this)), m_plot(new WorkPrecisionPlot(this)),
      m_show(new QToolButton(this))
{
   setObjectName(QStringLiteral("accuracySection"));
   m_ask->line()->setObjectName(QStringLiteral("accuracy.ask"));
   m_ask->setPlaceholder(tr("1 %"));
   m_ask->setToolTip(tr("The error to stay within: the cheapest settings that do are searched for and set"));
   m_pick->setObjectName(QStringLiteral("accuracy.pick"));
   m_pick->setFocusPolicy(Qt::TabFocus); // a click must not first commit the field by leaving it
   m_show->setObjectName(QStringLiteral("accuracy.showBond"));
   m_show->setText(tr("Show"));
   m_show->setAccessibleName(tr("Show the bond that limits the step"));
   m_show->setCheckable(true);
   m_wait.setSingleShot(true);

   auto *account = new RunAccount(
       player,
       [this] {
          const AccuracyProbe *found = probe();
          return found ? std::optional(found->stepSeconds) : std::nullopt;
       },
       this);
   auto *asking = new QHBoxLayout;
   auto *label = new QLabel(tr("Stay &within"), this);
   label->setBuddy(m_ask->line());
   asking->addWidget(label, 0, Qt::AlignTop);
   asking->addWidget(m_ask, 1);
   asking->addWidget(m_pick, 0, Qt::AlignTop);
   auto *limit = new QHBoxLayout;
   limit->addWidget(m_limit, 1);
   limit->addWidget(m_show, 0, Qt::AlignTop);
   auto *layout = new QVBoxLayout(this);
   layout->setContentsMargins(8, 8, 8, 8);
   layout->setSpacing(7);
   layout->addWidget(m_status);
   layout->addWidget(m_table);
   layout->addWidget(m_plot);
   layout->addLayout(limit);
   layout->addLayout(asking);
   layout->addWidget(m_answerLabel);
   layout->addWidget(account);
   layout->addStretch();

   connect(&m_wait, &QTimer::timeout, this, &AccuracySection::beginProbe);
   connect(m_table, &AccuracyTable::applied, this, &AccuracySection::applyStep);
   connect(m_pick, &QPushButton::clicked, this, [this] {
      if (m_choosing.busy()) {
         m_choosing.cancel();
         wantProbe();
         refresh();
      } else {
         m_ask->submit();
      }
   });
   connect(m_show, &QToolButton::toggled, this, [this](bool on) {
      const AccuracyProbe *found = probe();
      emit evidenceChosen(on && found && found->limit.hasBond
                              ? std::vector<Index>{found->limit.a, found->limit.b}
                              : std::vector<Index>());
   });
   connect(session, &Session::designChanged, this, &AccuracySection::designChanged);
   connect(session, &Session::designReplaced, account, &QLabel::clear);
   connect(player, &SimulationPlayer::stateChanged, this, &AccuracySection::runChanged);
   refresh();
}

void AccuracySection::showEvent(QShowEvent *event)
{
   QWidget::showEvent(event);
   if (event->spontaneous())
      return;
   wantProbe();
   refresh();
}

void AccuracySection::hideEvent(QHideEvent *event)
{
   QWidget::hideEvent(event);
   if (event->spontaneous())
      return;
   m_wait.stop();
   m_probing.cancel();
   m_choosing.cancel();
   m_show->setChecked(false);
}

Subject AccuracySection::subject() const
{
   return {m_session->catalogue(), m_session->hierarchy(), m_session->design().setup, 1};
}

bool AccuracySection::isOfDesign(const Design &design) const
{
   return sameButStep(design.setup, m_session->design().setup) && design.model == m_session->design().model;
}

const AccuracyProbe *AccuracySection::probe() const
{
   return m_probe && m_probe->ok() && isOfDesign(m_design) ? &m_probe->value() : nullptr;
}

void AccuracySection::designChanged()
{
   m_show->setChecked(false);
   if (!m_applying) {
      m_answer.clear();
      m_choosing.cancel();
   }
   if (!isOfDesign(m_design)) {
      m_probe.reset();
      m_probing.cancel();
      m_wait.stop();
   }
   wantProbe();
   refresh();
}

void AccuracySection::wantProbe()
{
   const auto hierarchy = m_session->hierarchy();
   const bool can = isVisible() && hierarchy && hierarchy->cells() > 0 && !m_player->playing();
   const bool known = isOfDesign(m_design) && (m_probe || m_probing.busy());
   if (can && !known && !m_choosing.busy())
      m_wait.start(kIdle);
}

void AccuracySection::beginProbe()
{
   m_design = m_session->design();
   m_probe.reset();
   auto found = std::make_shared<std::optional<Result<AccuracyProbe>>>();
   m_probing.start(
       [found, subject = subject()](const Job &job) { found->emplace(probeDesign(subject, job)); },
       [this, found] {
          m_probe = std::move(*found);
          refresh();
       });
   refresh();
}

void AccuracySection::applyStep(double step)
{
   if (step > 0 && step != m_session->design().setup.step)
      m_session->run("step", {{"step_s", step}});
}

QString AccuracySection::ask(const QString &text)
{
   const auto error = parsePercent(text);
   if (!error)
      return tr("\"%1\" is no accuracy: write a percentage above 0 and below 100, such as 1 %.").arg(text);
   if (!m_session->hierarchy() || m_session->hierarchy()->cells() == 0)
      return tr("There is nothing to simulate yet: place some cells first.");
   m_ask->setValue(figureText(100 * *error) + QStringLiteral(" %"));
   choose(*error);
   return {};
}

void AccuracySection::choose(double error)
{
   m_wait.stop();
   m_probing.cancel();
   m_answer.clear();
   auto found = std::make_shared<std::optional<Result<AccuracyChoice>>>();
   m_choosing.start(
       [found, subject = subject(), error](const Job &job) {
          found->emplace(chooseForDesign(subject, error, job));
       },
       [this, found] {
          if (found->value())
             takeChoice(***found);
          else
             m_answer =
                 tr("No settings were picked: %1.").arg(QString::fromStdString((*found)->error().message));
          wantProbe();
          refresh();
       });
   refresh();
}

void AccuracySection::takeChoice(const AccuracyChoice &choice)
{
   const SettingOption &best = choice.best();
   const Values values = mergedValues(*m_session->catalogue(), m_session->design().setup, best.values);
   const bool known = best.error.how != Knowledge::unknown;
   m_answer =
       tr("Picked %1, step %2: error %3, the run takes %4 (%5). %6. Undo takes it back.")
           .arg(QString::fromStdString(best.setting), durationText(best.step),
                known ? percentText(best.error.value)
                      : tr("%1 over the first %2, beyond it unknown")
                            .arg(percentText(best.withinError), durationText(best.window)),
                durationText(best.seconds.value), QString::fromUtf8(knowledgeText(best.seconds.how).data()),
                wordText(QString::fromStdString(choice.why)));
   m_applying = true;
   m_session->run("set-solver", {{"values", valuesArgument(values)}, {"step_s", best.step}});
   m_applying = false;
}

/// A probe beside a run would slow it, and be slowed.
void AccuracySection::runChanged()
{
   if (m_player->playing()) {
      m_wait.stop();
      m_probing.cancel();
   }
   wantProbe();
   refresh();
}

std::optional<PresetEstimate> AccuracySection::estimateNow() const
{
   const AccuracyProbe *found = probe();
   if (!found)
      return std::nullopt;
   const Setup &setup = m_session->design().setup;
   const double step = setup.step > 0
                           ? setup.step
                           : automaticFraction(*m_session->catalogue(), setup) * found->limit.stableStep;
   if (!(step > 0))
      return std::nullopt;
   PresetEstimate now = estimateAt(*found, tr("as set now").toStdString(), step);
   for (const PresetEstimate &preset : found->presets)
      if (std::abs(step / preset.step - 1) < 1e-6)
         now.error = preset.error; // which may have been measured
   if (found->limit.stableStep > 0 && step > found->limit.stableStep * (1 + 1e-9))
      now.seconds = now.error;
   return now;
}

void AccuracySection::refresh()
{
   const AccuracyProbe *found = probe();
   const auto now = estimateNow();
   m_table->setEstimates(found ? found->presets : std::vector<PresetEstimate>(), now);
   m_plot->setEstimates(found ? found->presets : std::vector<PresetEstimate>(), now);
   m_plot->setVisible(found);
   showStatus();
   showLimit();
   m_pick->setText(m_choosing.busy() ? tr("Stop") : tr("Pick settings"));
   m_answerLabel->setText(m_choosing.busy() ? tr("Trying every integrator and precision on this design...")
                                            : m_answer);
   m_answerLabel->setVisible(!m_answerLabel->text().isEmpty());
   emit stableStepKnown(found ? found->limit.stableStep : 0);
}

void AccuracySection::showStatus()
{
   const auto hierarchy = m_session->hierarchy();
   const AccuracyProbe *found = probe();
   if (!hierarchy)
      m_status->setText(tr("The design's lattice is not installed: it cannot be tried."));
   else if (hierarchy->cells() == 0)
      m_status->setText(
          tr("Place some cells and hold or load them: short runs then show what accuracy costs."));
   else if (found) {
      const Quantity &quantity = found->quantity;
      m_status->setText(tr("Error of %1 of cell %2, which moves most, in a run of %3%4.")
                            .arg(QString::fromStdString(quantity.channel),
                                 cellsText(std::vector{quantity.cell}), durationText(found->until),
                                 m_session->design().setup.until > 0
                                     ? QString()
                                     : tr(" (set how long a run lasts under Settings)")));
   } else if (m_probe && isOfDesign(m_design))
      m_status->setText(
          tr("What accuracy costs is unknown: %1.").arg(QString::fromStdString(m_probe->error().message)));
   else if (m_player->playing())
      m_status->setText(
          tr("Measuring waits while the simulation plays: pause it to see what accuracy costs."));
   else
      m_status->setText(tr("Measuring on this design: short runs at three step lengths..."));
}

void AccuracySection::showLimit()
{
   const AccuracyProbe *found = probe();
   m_show->setVisible(found && found->limit.hasBond);
   m_limit->setVisible(found);
   if (!found)
      return;
   const StepLimit &limit = found->limit;
   if (!(limit.stableStep > 0)) {
      m_limit->setText(tr("The solver has no limit to the step."));
      return;
   }
   QString text =
       tr("The longest stable step, %1, is set by %2.")
           .arg(durationText(limit.stableStep),
                limit.hasBond ? QString::fromStdString(limit.text()) : tr("something other than a bond"));
   if (limit.gainWithout)
      text += tr(" Without bonds of these materials it could be %1 times longer.")
                  .arg(figureText(*limit.gainWithout));
   m_limit->setText(text);
}

} // namespace diatom::gui
