// Runs a simulation of a snapshot in a thread of its own, at the pace of real time or as fast as it can, and
// hands over frames to draw. The document may be edited meanwhile; the run goes on with what it was given.
#pragma once

#include "cells/hierarchy.h"
#include "document/design.h"
#include "plugins/catalogue.h"
#include "render/scene_view.h"
#include "scene/simulation.h"

#include <QObject>
#include <QString>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

class QThread;

namespace diatom::gui {

/// What a run has done so far.
struct RunTally
{
   double time = 0;        // s, simulated
   double step = 0;        // s, in use
   double wallSeconds = 0; // spent stepping
   std::int64_t steps = 0;
};

class SimulationPlayer : public QObject
{
   Q_OBJECT

public:
   explicit SimulationPlayer(QObject *parent = nullptr);
   ~SimulationPlayer() override;

   bool active() const { return m_thread != nullptr; } // a run exists, playing or paused
   bool playing() const { return m_playing; }
   /// The run came to the end that the design asks for.
   bool finished() const { return m_finished; }
   /// The newest frame; null before the first.
   std::shared_ptr<const render::Moment> frame() const;
   /// As of the newest frame; all 0 before the first.
   RunTally tally() const;

   /// Goes on, or starts: anew after the end.
   void play(std::shared_ptr<const Catalogue> catalogue, const Design &design,
             std::shared_ptr<const Hierarchy> hierarchy);
   void pause();
   /// Ends the run and forgets it.
   void reset();

signals:
   void frameReady();
   void stateChanged();
   void failed(const QString &message);

private:
   struct Run;
   void fail(const QString &message);
   void finish();

   std::shared_ptr<Run> m_run;
   QThread *m_thread = nullptr;
   int m_number = 0; // of the run
   bool m_playing = false, m_finished = false;
};

} // namespace diatom::gui
