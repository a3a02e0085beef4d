// A line to type a value into, with the sentence that says what is wrong with it beside. Enter or leaving
// commits, Esc restores.
#pragma once

#include <QString>
#include <QWidget>

#include <functional>

class QLabel;
class QLineEdit;

namespace diatom::gui {

class ValueField : public QWidget
{
   Q_OBJECT

public:
   /// Takes the text; the sentence that comes back is shown, "" = it was taken.
   using Commit = std::function<QString(const QString &)>;

   ValueField(const QString &name, Commit commit, QWidget *parent);
   /// The value in force. What is being typed, or was refused, stays until it is committed or given up.
   void setValue(const QString &text);
   void setPlaceholder(const QString &text);
   /// Something worth knowing about the value in force; "" = nothing.
   void setNote(const QString &note);
   QLineEdit *line() const { return m_line; }
   /// Commits what stands there, also where it is the value in force; nothing typed is the placeholder.
   void submit();

protected:
   bool eventFilter(QObject *watched, QEvent *event) override;

private:
   void commit();
   void restore();
   void showWords();

   Commit m_commit;
   QLineEdit *m_line;
   QLabel *m_words;
   QString m_value, m_note, m_fault, m_refused;
};

} // namespace diatom::gui
