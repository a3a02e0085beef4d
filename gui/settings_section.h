// How the open design is run: solver, every choice that the solver declares, step and length of the run. All
// are commands of the document.
#pragma once

#include "gui/session.h"
#include "gui/value_field.h"

#include <QWidget>

#include <vector>

class QComboBox;
class QFormLayout;

namespace diatom::gui {

class SettingsSection : public QWidget
{
   Q_OBJECT

public:
   SettingsSection(Session *session, QWidget *parent);
   /// s: longest stable step of the design as it is; 0 = not known, or none.
   void setStableStep(double step);

private:
   void refresh();
   void makeChoices();
   void chooseSolver();
   void chooseValue(const QComboBox *box);
   QString commitStep(const QString &text);
   QString commitUntil(const QString &text);

   Session *m_session;
   QFormLayout *m_form;
   QComboBox *m_solver;
   std::vector<QComboBox *> m_choices; // of the solver that they were made for
   std::string m_choicesOf;
   ValueField *m_step, *m_until;
   double m_stableStep = 0;
};

} // namespace diatom::gui
