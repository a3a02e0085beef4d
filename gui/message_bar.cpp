#include "gui/message_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>

namespace diatom::gui {

MessageBar::MessageBar(QWidget *parent) : QFrame(parent), m_label(new QLabel(this))
{
   setObjectName(QStringLiteral("messageBar"));
   setAutoFillBackground(true);
   auto *close = new QToolButton(this);
   close->setText(tr("Close"));
   close->setAccessibleName(tr("Close message"));
   close->setAutoRaise(true);
   connect(close, &QToolButton::clicked, this, &QWidget::hide);
   m_label->setWordWrap(true);
   m_label->setTextInteractionFlags(Qt::TextSelectableByMouse);
   auto *layout = new QHBoxLayout(this);
   layout->setContentsMargins(10, 4, 6, 4);
   layout->addWidget(m_label, 1);
   layout->addWidget(close);
   hide();
}

void MessageBar::showMessage(const QString &message, bool error)
{
   QPalette colors;
   colors.setColor(QPalette::Window, error ? QColor(0xf6, 0xd5, 0xd0) : QColor(0xd8, 0xe6, 0xf4));
   colors.setColor(QPalette::WindowText, QColor(0x20, 0x20, 0x20));
   setPalette(colors);
   m_label->setPalette(colors);
   m_label->setText(message);
   setAccessibleName(message);
   show();
}

QString MessageBar::text() const { return isVisible() ? m_label->text() : QString(); }

} // namespace diatom::gui
