#include "gui/simulation_player.h"

#include "core/clock.h"
#include "render/color_map.h"

#include <QThread>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace diatom::gui {

namespace {

constexpr double kFrameSeconds = 1.0 / 60; // between frames, and the most simulated in one go
constexpr double kSliceSeconds = 0.008;    // of wall time aimed at, so that pause and cancel act at once

constexpr double kForever = 1e9; // s, of a run without an end

/// As many steps as fit into the slice (s), at least one. Told by their number and not by a time, they are
/// those of a run without slices.
std::int64_t stepsIn(double slice, double step)
{
   return step > 0 ? std::max<std::int64_t>(1, static_cast<std::int64_t>(slice / step)) : 1;
}

} // namespace

/// What the two threads share.
struct SimulationPlayer::Run
{
   std::shared_ptr<const Catalogue> catalogue;
   Design design;
   std::shared_ptr<const Hierarchy> hierarchy;
   Job job; // cancelled to end the run

   std::mutex mutex;
   std::condition_variable wake;
   bool playing = true;                         // guarded
   std::shared_ptr<const render::Moment> frame; // guarded
   RunTally tally;                              // guarded
   bool taken = true;                           // guarded: the frame was looked at since it was put
   std::function<void()> announce;              // tells the window that there is a frame
   std::function<void()> announceEnd;

   std::shared_ptr<const std::vector<Index>> indices;
   std::vector<double> rest;
   double highest = 0;

   bool wait();
   Status publish(const Simulation &simulation, double factor);
   Status work();
   Status play(Simulation &simulation);
};

/// Sleeps while paused. False when the run is to end.
bool SimulationPlayer::Run::wait()
{
   std::unique_lock lock(mutex);
   wake.wait(lock, [this] { return playing || job.cancelled(); });
   return !job.cancelled();
}

Status SimulationPlayer::Run::publish(const Simulation &simulation, double factor)
{
   auto now = simulation.frame(job);
   if (!now)
      return now.error();
   auto made = std::make_shared<render::Moment>();
   made->frame = std::move(*now);
   if (rest.empty())
      rest = made->frame.position;
   auto magnitudes = render::displacementMagnitudes(made->frame.position, rest);
   highest = std::max(highest, magnitudes.highest);
   made->indices = indices;
   made->values = std::move(magnitudes.values);
   made->highest = highest;
   made->realTimeFactor = factor;
   const std::lock_guard lock(mutex);
   frame = std::move(made);
   tally = {simulation.time(), simulation.step(), simulation.wallSeconds(), simulation.steps()};
   if (taken) // else the window is still busy with an earlier word, and will find this frame then
      announce();
   taken = false;
   return {};
}

Status SimulationPlayer::Run::work()
{
   auto scene = Scene::build(*hierarchy, design.setup, job);
   if (!scene)
      return scene.error();
   indices = std::make_shared<const std::vector<Index>>((*scene)->indices());
   auto simulation = Simulation::start(catalogue, std::move(*scene), design.setup, {}, job);
   if (!simulation)
      return simulation.error();
   if (Status status = publish(**simulation, 0); !status)
      return status;
   return play(**simulation);
}

Status SimulationPlayer::Run::play(Simulation &simulation)
{
   double slice = 1e-4, factor = 0;
   const double end = design.setup.until > 0 ? design.setup.until : kForever;
   while (wait()) {
      const auto resumed = Clock::now();
      const double from = simulation.time();
      auto measured = resumed;
      double measuredFrom = from;
      auto lastFrame = resumed;
      const auto stillPlaying = [this] {
         const std::lock_guard lock(mutex);
         return playing && !job.cancelled();
      };
      while (stillPlaying()) {
         const auto begin = Clock::now();
         if (Status status = simulation.advance(end, job, stepsIn(slice, simulation.step())); !status) {
            if (Status last = publish(simulation, factor); !last) // the last good state stays on screen
               return last;
            return status;
         }
         slice = std::clamp(slice * std::clamp(kSliceSeconds / std::max(secondsSince(begin), 1e-6), 0.5, 2.0),
                            simulation.step(), std::max(kFrameSeconds, simulation.step()));
         if (secondsSince(measured) > 0.5) {
            factor = (simulation.time() - measuredFrom) / secondsSince(measured);
            measured = Clock::now();
            measuredFrom = simulation.time();
         }
         if (simulation.time() >= end) {
            const std::lock_guard lock(mutex);
            playing = false;
            break;
         }
         const bool due = secondsSince(lastFrame) >= kFrameSeconds;
         if (due) {
            lastFrame = Clock::now();
            if (Status status = publish(simulation, factor); !status)
               return status;
         }
         // Never faster than real time.
         const double ahead = simulation.time() - from - secondsSince(resumed);
         if (ahead > 0) {
            std::unique_lock lock(mutex);
            wake.wait_for(lock, std::chrono::duration<double>(std::min(ahead, kFrameSeconds)),
                          [this] { return !playing || job.cancelled(); });
         }
      }
      if (Status status = publish(simulation, factor); !status)
         return status;
      if (simulation.time() >= end) {
         announceEnd();
         return {};
      }
   }
   return {};
}

SimulationPlayer::SimulationPlayer(QObject *parent) : QObject(parent) {}

SimulationPlayer::~SimulationPlayer() { reset(); }

std::shared_ptr<const render::Moment> SimulationPlayer::frame() const
{
   if (!m_run)
      return nullptr;
   const std::lock_guard lock(m_run->mutex);
   m_run->taken = true;
   return m_run->frame;
}

RunTally SimulationPlayer::tally() const
{
   if (!m_run)
      return {};
   const std::lock_guard lock(m_run->mutex);
   return m_run->tally;
}

void SimulationPlayer::play(std::shared_ptr<const Catalogue> catalogue, const Design &design,
                            std::shared_ptr<const Hierarchy> hierarchy)
{
   if (m_finished || (m_thread && m_thread->isFinished())) // it ended or failed: once more from the start
      reset();
   m_playing = true;
   if (m_run) {
      const std::lock_guard lock(m_run->mutex);
      m_run->playing = true;
      m_run->wake.notify_all();
   } else {
      auto run = std::make_shared<Run>();
      run->catalogue = std::move(catalogue);
      run->design = design;
      run->hierarchy = std::move(hierarchy);
      m_run = run;
      ++m_number; // word of a run that was reset meanwhile is dropped
      run->announce = [this, number = m_number] {
         QMetaObject::invokeMethod(
             this,
             [this, number] {
                if (m_run && number == m_number)
                   emit frameReady();
             },
             Qt::QueuedConnection);
      };
      run->announceEnd = [this, number = m_number] {
         QMetaObject::invokeMethod(
             this,
             [this, number] {
                if (m_run && number == m_number)
                   finish();
             },
             Qt::QueuedConnection);
      };
      m_thread = QThread::create([this, run, number = m_number] {
         const Status status = run->work();
         if (!status && status.error().code != ErrorCode::cancelled)
            QMetaObject::invokeMethod(
                this,
                [this, number, text = QString::fromStdString(status.error().message)] {
                   if (m_run && number == m_number)
                      fail(text);
                },
                Qt::QueuedConnection);
      });
      m_thread->start();
   }
   emit stateChanged();
}

void SimulationPlayer::pause()
{
   if (!m_run)
      return;
   m_playing = false;
   {
      const std::lock_guard lock(m_run->mutex);
      m_run->playing = false;
      m_run->wake.notify_all();
   }
   emit stateChanged();
}

void SimulationPlayer::fail(const QString &message)
{
   m_playing = false;
   emit failed(message);
   emit stateChanged();
}

void SimulationPlayer::finish()
{
   m_playing = false;
   m_finished = true;
   emit stateChanged();
}

void SimulationPlayer::reset()
{
   m_finished = false;
   if (!m_thread)
      return;
   {
      const std::lock_guard lock(m_run->mutex);
      m_run->job.cancel();
      m_run->wake.notify_all();
   }
   m_thread->wait();
   delete m_thread;
   m_thread = nullptr;
   m_run.reset();
   m_playing = false;
   emit stateChanged();
}

} // namespace diatom::gui
