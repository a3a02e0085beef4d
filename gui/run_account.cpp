#include "gui/run_account.h"

#include "gui/readable.h"

namespace diatom::gui {

RunAccount::RunAccount(SimulationPlayer *player, std::function<std::optional<double>()> told, QWidget *parent)
    : QLabel(parent), m_player(player), m_told(std::move(told))
{
   setObjectName(QStringLiteral("accuracy.account"));
   setWordWrap(true);
   hide();
   connect(player, &SimulationPlayer::stateChanged, this, &RunAccount::watch);
   connect(player, &SimulationPlayer::frameReady, this, &RunAccount::watch); // the last one follows the pause
}

void RunAccount::watch()
{
   if (!m_player->active()) {
      m_running = false;
      return;
   }
   if (!m_running) {
      m_running = true;
      m_toldStep = m_told();
   }
   const RunTally tally = m_player->tally();
   if (m_player->playing() || tally.steps <= 0)
      return;
   const QString run =
       tr("Last run, %1 in %2 steps:").arg(durationText(tally.time), QString::number(tally.steps));
   const QString took = tr("took %1 of stepping").arg(durationText(tally.wallSeconds));
   setText(m_toldStep ? tr("%1 told %2, %3.")
                            .arg(run, durationText(*m_toldStep * static_cast<double>(tally.steps)), took)
                      : tr("%1 %2; no time was told, as it began before there was a probe.").arg(run, took));
   show();
}

} // namespace diatom::gui
