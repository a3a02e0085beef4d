#include "gui/background.h"

#include <QThread>

#include <utility>

namespace diatom::gui {

Background::~Background()
{
   if (!m_thread)
      return;
   m_thread->disconnect(this);
   m_job->cancel();
   m_thread->wait();
   delete m_thread;
}

void Background::start(Work work, Done done)
{
   cancel();
   Request request{std::move(work), std::move(done)};
   if (m_thread) // two at once would disturb each other's timings
      m_next = std::move(request);
   else
      launch(std::move(request));
}

void Background::cancel()
{
   m_done = nullptr;
   m_next = {};
   if (m_job)
      m_job->cancel();
}

void Background::launch(Request request)
{
   m_done = std::move(request.done);
   m_job = std::make_shared<Job>();
   m_thread = QThread::create([job = m_job, work = std::move(request.work)] { work(*job); });
   connect(m_thread, &QThread::finished, this, &Background::finish);
   m_thread->start();
}

void Background::finish()
{
   m_thread->wait();
   m_thread->deleteLater();
   m_thread = nullptr;
   m_job.reset();
   const Done done = std::exchange(m_done, nullptr);
   if (m_next.work)
      launch(std::exchange(m_next, {}));
   else if (done)
      done();
}

} // namespace diatom::gui
