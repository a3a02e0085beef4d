// A line over the view for what went wrong or is worth knowing: never a dialog, gone with Esc or its button.
#pragma once

#include <QFrame>

class QLabel;

namespace diatom::gui {

class MessageBar : public QFrame
{
   Q_OBJECT

public:
   explicit MessageBar(QWidget *parent = nullptr);
   void showMessage(const QString &message, bool error);
   QString text() const;

private:
   QLabel *m_label;
};

} // namespace diatom::gui
