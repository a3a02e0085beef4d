// One piece of work in a thread of its own, where a newer request takes the place of an older one. Nothing
// here ever waits but the destructor.
#pragma once

#include "core/job.h"

#include <QObject>

#include <functional>
#include <memory>

class QThread;

namespace diatom::gui {

class Background : public QObject
{
   Q_OBJECT

public:
   using Work = std::function<void(const Job &)>;
   using Done = std::function<void()>;

   explicit Background(QObject *parent) : QObject(parent) {}
   ~Background() override;

   /// Whether done() of a request is still to come.
   bool busy() const { return m_done || m_next.done; }
   /// Cancels what is going on, and when that has ended runs `work`, then `done` in the caller's thread.
   void start(Work work, Done done);
   /// What is going on ends as soon as it can; its done() is not called.
   void cancel();

private:
   struct Request
   {
      Work work;
      Done done;
   };
   void launch(Request request);
   void finish();

   QThread *m_thread = nullptr;
   std::shared_ptr<Job> m_job;
   Done m_done;
   Request m_next;
};

} // namespace diatom::gui
