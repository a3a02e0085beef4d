// Long work in a thread of its own, with its name, progress and a Cancel button in the status bar.
#pragma once

#include "core/job.h"

#include <QString>
#include <QWidget>

#include <functional>
#include <memory>

class QLabel;
class QProgressBar;
class QThread;

namespace diatom::gui {

class TaskRow : public QWidget
{
   Q_OBJECT

public:
   explicit TaskRow(QWidget *parent = nullptr);
   ~TaskRow() override;

   bool busy() const { return m_thread != nullptr; }
   /// Runs `work` away from the window, then `done` in it. One at a time; false when busy.
   bool start(const QString &name, std::function<void(const Job &)> work, std::function<void()> done);

private:
   void finish();

   QLabel *m_name;
   QProgressBar *m_bar;
   QThread *m_thread = nullptr;
   std::shared_ptr<Job> m_job;
   std::function<void()> m_done;
};

} // namespace diatom::gui
