#include "gui/settings_section.h"

#include "gui/readable.h"
#include "gui/solver_values.h"
#include "study/settings.h"

#include <QComboBox>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>

namespace diatom::gui {

SettingsSection::SettingsSection(Session *session, QWidget *parent)
    : QWidget(parent), m_session(session), m_form(new QFormLayout(this)), m_solver(new QComboBox(this)),
      m_step(new ValueField(
          tr("Time step"), [this](const QString &text) { return commitStep(text); }, this)),
      m_until(new ValueField(
          tr("Length of the run"), [this](const QString &text) { return commitUntil(text); }, this))
{
   setObjectName(QStringLiteral("settingsSection"));
   m_form->setContentsMargins(8, 8, 8, 8);
   m_form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
   m_solver->setObjectName(QStringLiteral("setting.solver"));
   m_solver->setAccessibleName(tr("Solver"));
   for (const Offer &offer : session->catalogue()->offers(DIATOM_SOLVER_1)) {
      m_solver->addItem(QString::fromStdString(offer.provided->name),
                        QString::fromStdString(offer.provided->id));
      m_solver->setItemData(m_solver->count() - 1, QString::fromStdString(offer.provided->summary),
                            Qt::ToolTipRole);
   }
   m_step->line()->setObjectName(QStringLiteral("setting.step"));
   m_step->setToolTip(tr("auto, or a time such as 20 us: shorter steps are more accurate and take longer"));
   m_until->line()->setObjectName(QStringLiteral("setting.until"));
   m_until->setPlaceholder(tr("until it is stopped"));
   m_until->setToolTip(
       tr("The simulated time after which a run ends, such as 2 s; empty = until it is stopped"));
   m_form->addRow(tr("Solver"), m_solver);
   m_form->addRow(tr("Time step"), m_step);
   m_form->addRow(tr("Run lasts"), m_until);
   connect(m_solver, &QComboBox::activated, this, &SettingsSection::chooseSolver);
   connect(session, &Session::designChanged, this, &SettingsSection::refresh);
   refresh();
}

void SettingsSection::setStableStep(double step)
{
   m_stableStep = step;
   const double asked = m_session->design().setup.step;
   m_step->setNote(
       step > 0 && asked > step * (1 + 1e-9)
           ? tr("Longer than the longest stable step, %1: the run will be refused. Write auto, or less.")
                 .arg(durationText(step))
           : QString());
}

void SettingsSection::makeChoices()
{
   for (QComboBox *box : m_choices)
      m_form->removeRow(box);
   m_choices.clear();
   m_choicesOf = m_session->design().setup.solver;
   const Offer *offer = m_session->catalogue()->offer(DIATOM_SOLVER_1, m_choicesOf);
   if (!offer)
      return;
   for (const Parameter &parameter : offer->provided->parameters) {
      if (parameter.kind != Parameter::Kind::choice)
         continue;
      const QString name = QString::fromStdString(parameter.name);
      auto *box = new QComboBox(this);
      box->setObjectName(QStringLiteral("setting.") + name);
      box->setProperty("parameter", name);
      box->setAccessibleName(wordText(name));
      box->setToolTip(QString::fromStdString(parameter.help));
      for (const std::string &choice : parameter.choices)
         box->addItem(wordText(QString::fromStdString(choice)), QString::fromStdString(choice));
      connect(box, &QComboBox::activated, this, [this, box] { chooseValue(box); });
      m_choices.push_back(box);
      m_form->insertRow(static_cast<int>(m_choices.size()), wordText(name), box);
      if (QWidget *label = m_form->labelForField(box))
         label->setToolTip(box->toolTip());
   }
}

void SettingsSection::refresh()
{
   const Setup &setup = m_session->design().setup;
   if (setup.solver != m_choicesOf)
      makeChoices();
   m_solver->setCurrentIndex(m_solver->findData(QString::fromStdString(setup.solver)));
   if (m_solver->currentIndex() < 0)
      m_solver->setPlaceholderText(tr("%1 is not installed").arg(QString::fromStdString(setup.solver)));
   std::vector<std::string> names;
   for (const QComboBox *box : m_choices)
      names.push_back(box->property("parameter").toString().toStdString());
   const std::vector<std::string_view> wanted(names.begin(), names.end());
   for (const Choice &choice :
        solverChoices(*m_session->catalogue(), setup.solver, setup.solverValues, wanted))
      for (QComboBox *box : m_choices)
         if (box->property("parameter").toString().toStdString() == choice.name)
            box->setCurrentIndex(box->findData(QString::fromStdString(choice.choices.front())));
   m_step->setValue(setup.step > 0 ? durationText(setup.step) : tr("auto"));
   m_until->setValue(setup.until > 0 ? durationText(setup.until) : QString());
   setStableStep(0); // of the design before
}

void SettingsSection::chooseSolver()
{
   const std::string id = m_solver->currentData().toString().toStdString();
   if (id != m_session->design().setup.solver)
      m_session->run("set-solver", {{"id", id}});
   refresh();
}

void SettingsSection::chooseValue(const QComboBox *box)
{
   const Setup &setup = m_session->design().setup;
   const Values changed{
       {box->property("parameter").toString().toStdString(), box->currentData().toString().toStdString()}};
   const Values values = mergedValues(*m_session->catalogue(), setup, changed);
   if (values != setup.solverValues)
      m_session->run("set-solver", {{"values", valuesArgument(values)}});
   refresh();
}

QString SettingsSection::commitStep(const QString &text)
{
   std::optional<double> step;
   if (text.compare(tr("auto"), Qt::CaseInsensitive) == 0 || text.isEmpty())
      step = 0;
   else
      step = parseDuration(text);
   if (!step)
      return tr("\"%1\" is no time step: write auto, or a time above 0 such as 20 us.").arg(text);
   return m_session->tryRun("step", {{"step_s", *step}});
}

QString SettingsSection::commitUntil(const QString &text)
{
   const auto until = text.isEmpty() ? std::optional(0.0) : parseDuration(text);
   if (!until)
      return tr("\"%1\" is no length of a run: write a time above 0 such as 2 s, or leave it empty.")
          .arg(text);
   return m_session->tryRun("until", {{"until_s", *until}});
}

} // namespace diatom::gui
