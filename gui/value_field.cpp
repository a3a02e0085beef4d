#include "gui/value_field.h"

#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QVBoxLayout>

namespace diatom::gui {

ValueField::ValueField(const QString &name, Commit commit, QWidget *parent)
    : QWidget(parent), m_commit(std::move(commit)), m_line(new QLineEdit(this)), m_words(new QLabel(this))
{
   m_line->setAccessibleName(name);
   m_words->setWordWrap(true);
   m_words->hide();
   setFocusProxy(m_line);
   m_line->installEventFilter(this);
   connect(m_line, &QLineEdit::editingFinished, this, &ValueField::commit);
   auto *layout = new QVBoxLayout(this);
   layout->setContentsMargins(0, 0, 0, 0);
   layout->setSpacing(2);
   layout->addWidget(m_line);
   layout->addWidget(m_words);
}

void ValueField::setValue(const QString &text)
{
   m_value = text;
   if (m_fault.isEmpty() && !m_line->isModified())
      m_line->setText(text);
}

void ValueField::setPlaceholder(const QString &text) { m_line->setPlaceholderText(text); }

void ValueField::setNote(const QString &note)
{
   m_note = note;
   showWords();
}

void ValueField::showWords()
{
   const QString &words = m_fault.isEmpty() ? m_note : m_fault;
   m_words->setText(words);
   m_words->setVisible(!words.isEmpty());
   m_words->setStyleSheet(m_fault.isEmpty() ? QString() : QStringLiteral("color: #b3261e;"));
   m_line->setAccessibleDescription(words);
}

void ValueField::commit()
{
   const QString text = m_line->text().trimmed();
   if (!m_line->isModified() || (!m_fault.isEmpty() && text == m_refused))
      return;
   if (text == m_value) {
      restore();
      return;
   }
   m_line->setModified(false); // before the commit, which sets the new value
   m_fault.clear();
   m_fault = m_commit(text);
   m_refused = text;
   m_line->setModified(!m_fault.isEmpty());
   if (m_fault.isEmpty())
      m_line->setText(m_value);
   showWords();
}

void ValueField::submit()
{
   if (m_line->text().trimmed().isEmpty())
      m_line->setText(m_line->placeholderText());
   m_value.clear();
   m_fault.clear();
   m_line->setModified(true);
   commit();
}

void ValueField::restore()
{
   m_fault.clear();
   m_line->setText(m_value);
   showWords();
}

bool ValueField::eventFilter(QObject *watched, QEvent *event)
{
   const bool escape = (event->type() == QEvent::ShortcutOverride || event->type() == QEvent::KeyPress) &&
                       static_cast<QKeyEvent *>(event)->key() == Qt::Key_Escape;
   if (!escape)
      return QWidget::eventFilter(watched, event);
   if (event->type() == QEvent::KeyPress)
      restore();
   event->accept();
   return true;
}

} // namespace diatom::gui
