#include "gui/task_row.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QThread>
#include <QToolButton>

#include <utility>

namespace diatom::gui {

TaskRow::TaskRow(QWidget *parent) : QWidget(parent), m_name(new QLabel(this)), m_bar(new QProgressBar(this))
{
   setObjectName(QStringLiteral("task"));
   auto *cancel = new QToolButton(this);
   cancel->setObjectName(QStringLiteral("task.cancel"));
   cancel->setText(tr("Cancel"));
   cancel->setToolTip(tr("Stop the work that is going on"));
   m_bar->setRange(0, 1000);
   m_bar->setMaximumWidth(160);
   m_bar->setAccessibleName(tr("Progress"));
   auto *layout = new QHBoxLayout(this);
   layout->setContentsMargins(0, 0, 0, 0);
   layout->addWidget(m_name);
   layout->addWidget(m_bar);
   layout->addWidget(cancel);
   connect(cancel, &QToolButton::clicked, this, [this] {
      if (m_job)
         m_job->cancel();
   });
   hide();
}

TaskRow::~TaskRow()
{
   if (!m_thread)
      return;
   m_job->cancel();
   m_thread->wait();
   delete m_thread;
}

bool TaskRow::start(const QString &name, std::function<void(const Job &)> work, std::function<void()> done)
{
   if (m_thread)
      return false;
   m_name->setText(name);
   m_bar->setValue(0);
   m_done = std::move(done);
   m_job = std::make_shared<Job>([this, shown = -1](double fraction, std::string_view) mutable {
      const int value = static_cast<int>(1000 * fraction);
      if (value == shown)
         return;
      shown = value;
      QMetaObject::invokeMethod(
          m_bar, [this, value] { m_bar->setValue(value); }, Qt::QueuedConnection);
   });
   m_thread = QThread::create([job = m_job, work = std::move(work)] { work(*job); });
   connect(m_thread, &QThread::finished, this, &TaskRow::finish);
   show();
   m_thread->start();
   return true;
}

void TaskRow::finish()
{
   m_thread->wait();
   m_thread->deleteLater();
   m_thread = nullptr;
   m_job.reset();
   hide();
   if (const auto done = std::exchange(m_done, nullptr))
      done();
}

} // namespace diatom::gui
