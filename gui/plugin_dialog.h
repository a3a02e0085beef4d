// Every plugin that was found, with its verdict; trust and another trial for those from outside.
#pragma once

#include "plugins/catalogue.h"

#include <QDialog>

#include <memory>

class QLabel;
class QPushButton;
class QTreeWidget;

namespace diatom::gui {

class PluginDialog : public QDialog
{
   Q_OBJECT

public:
   explicit PluginDialog(std::shared_ptr<const Catalogue> catalogue, QWidget *parent = nullptr);

private:
   const Candidate *chosen() const;
   void updateButtons();
   void trust();
   void retry();
   void tell(const QString &text);

   std::shared_ptr<const Catalogue> m_catalogue;
   QTreeWidget *m_list;
   QPushButton *m_trust, *m_retry;
   QLabel *m_words;
};

} // namespace diatom::gui
