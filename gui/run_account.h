// What became of a told time: beside it the time that a run's steps took, once the run pauses or ends.
#pragma once

#include "gui/simulation_player.h"

#include <QLabel>

#include <functional>
#include <optional>

namespace diatom::gui {

class RunAccount : public QLabel
{
   Q_OBJECT

public:
   /// `told` is asked when a run starts: s of wall time a step, where that is known.
   RunAccount(SimulationPlayer *player, std::function<std::optional<double>()> told, QWidget *parent);

private:
   void watch();

   SimulationPlayer *m_player;
   std::function<std::optional<double>()> m_told;
   bool m_running = false;           // a run was seen to start
   std::optional<double> m_toldStep; // before that run
};

} // namespace diatom::gui
