#include "gui/main_window.h"

#include "gui/plugin_dialog.h"

#include <QCloseEvent>
#include <QDockWidget>
#include <QLabel>
#include <QLocale>
#include <QMessageBox>
#include <QVBoxLayout>

#include <algorithm>

namespace diatom::gui {

namespace {

constexpr int kLayoutVersion = 1;

} // namespace

MainWindow::MainWindow(std::shared_ptr<const Catalogue> catalogue, QSettings *settings, QWidget *parent)
    : QMainWindow(parent), m_settings(settings), m_session(std::move(catalogue)), m_actions(this)
{
   setObjectName(QStringLiteral("mainWindow"));
   auto *central = new QWidget(this);
   auto *layout = new QVBoxLayout(central);
   layout->setContentsMargins(0, 0, 0, 0);
   layout->setSpacing(0);
   m_messages = new MessageBar(central);
   m_viewport = new Viewport(&m_session, central);
   layout->addWidget(m_messages);
   layout->addWidget(m_viewport, 1);
   setCentralWidget(central);
   m_legend = new LegendWidget(m_viewport);
   m_hint = new QLabel(m_viewport);
   m_hint->setObjectName(QStringLiteral("hint"));
   m_hint->setAttribute(Qt::WA_TransparentForMouseEvents);
   m_hint->setStyleSheet(QStringLiteral(
       "background: rgba(255,255,255,205); color: #1e242c; border-radius: 5px; padding: 4px 8px;"));
   m_hint->hide();

   makeDocks();
   makeMenus();
   makeToolColumn();
   makeStatusBar();
   connectActions();
   connectViews();
   m_viewport->installEventFilter(this);
   resize(1280, 800);
   if (m_settings) {
      restoreGeometry(m_settings->value("window/geometry").toByteArray());
      restoreState(m_settings->value("window/state").toByteArray(), kLayoutVersion);
      m_panel->setCurrentIndex(m_settings->value("simulationPanel/page", 0).toInt());
   }
   updateActions();
   updateCounts();
   updateRun();
   m_viewport->setFocus();
}

MainWindow::~MainWindow()
{
   m_player.disconnect();
   hide(); // while what the panels' and docks' signals lead to is still there
}

void MainWindow::on(std::string_view action, std::function<void()> act)
{
   connect(m_actions[action], &QAction::triggered, this, std::move(act));
}

void MainWindow::connectActions()
{
   on("file.open", [this] { chooseAndOpen(); });
   on("file.save", [this] { save(false); });
   on("file.saveAs", [this] { save(true); });
   on("file.export", [this] { chooseExport(); });
   on("file.quit", [this] { close(); });
   on("edit.undo", [this] { m_session.undo(); });
   on("edit.redo", [this] { m_session.redo(); });
   on("edit.place", [this] { m_viewport->builder().act(); });
   on("edit.fill", [this] { m_viewport->builder().fillRegion(); });
   on("edit.eraseRegion", [this] { m_viewport->builder().eraseRegion(); });
   on("edit.cancel", [this] {
      m_viewport->builder().cancel();
      m_messages->hide();
   });
   for (const auto &[id, tool] : {std::pair{"tool.place", Tool::place}, std::pair{"tool.erase", Tool::erase},
                                  std::pair{"tool.paint", Tool::paint}, std::pair{"tool.pick", Tool::pick}})
      on(id, [this, t = tool] { m_viewport->builder().setTool(t); });
   for (const char *name : {"iso", "front", "back", "left", "right", "top", "bottom"})
      on(std::string("view.") + name,
         [this, direction = *render::viewDirection(name)] { m_viewport->look(direction); });
   on("view.fit", [this] { m_viewport->fit(); });
   on("view.orthographic",
      [this] { m_viewport->setOrthographic(m_actions["view.orthographic"]->isChecked()); });
   on("view.grid", [this] { m_viewport->setGrid(m_actions["view.grid"]->isChecked()); });
   on("view.cells", [this] { m_viewport->setHierarchyView(false); });
   on("view.hierarchy", [this] { m_viewport->setHierarchyView(true); });
   on("view.parts", [this] { showAs(GeometryOptions::What::parts); });
   on("view.struts", [this] { showAs(GeometryOptions::What::struts); });
   on("simulate.play", [this] { togglePlay(); });
   on("simulate.reset", [this] {
      forgetBalance();
      m_player.reset();
   });
   on("simulate.balance", [this] { showBalance(); });
   on("simulate.colour", [this] { showFrame(); });
   on("simulate.panel", [this] {
      m_panelDock->setVisible(m_actions["simulate.panel"]->isChecked());
      if (m_panelDock->isVisible())
         m_panel->setFocus();
      else
         m_viewport->setFocus();
   });
   on("help.keys", [this] { showKeys(); });
   on("help.plugins", [this] {
      auto *dialog = new PluginDialog(m_session.catalogue(), this);
      dialog->setAttribute(Qt::WA_DeleteOnClose);
      dialog->open();
   });
   on("help.about", [this] { showAbout(); });
}

void MainWindow::connectViews()
{
   const auto showError = [this](const QString &text) { m_messages->showMessage(text, true); };
   connect(&m_session, &Session::failed, this, showError);
   connect(&m_session, &Session::noted, this,
           [this](const QString &text) { m_messages->showMessage(text, false); });
   connect(&m_session, &Session::designChanged, this, [this] {
      editStarted();
      updateActions();
      updateCounts();
   });
   connect(&m_session, &Session::fileChanged, this, &MainWindow::updateActions);
   connect(m_panelDock, &QDockWidget::visibilityChanged, this,
           [this] { m_actions["simulate.panel"]->setChecked(!m_panelDock->isHidden()); });
   connect(m_panel, &SimulationPanel::failed, this, showError);
   connect(m_panel, &SimulationPanel::evidenceChosen, m_viewport, &Viewport::setHighlight);
   connect(m_viewport, &Viewport::failed, this, showError);
   connect(m_references, &ReferenceMenu::noted, this, showError);
   connect(m_viewport, &Viewport::playWanted, this, &MainWindow::togglePlay);
   connect(m_viewport, &Viewport::hoverChanged, this, [this] {
      m_address->setText(m_viewport->builder().address());
      m_hint->setText(m_viewport->builder().hint());
      placeOverlays();
      updateActions();
   });
   connect(m_viewport, &Viewport::framePainted, this,
           [this] { m_speed->setText(tr("%1 ms").arg(1e3 * m_viewport->drawSeconds(), 0, 'f', 1)); });
   connect(&m_player, &SimulationPlayer::frameReady, this, &MainWindow::showFrame);
   connect(&m_player, &SimulationPlayer::failed, this, showError);
   connect(&m_player, &SimulationPlayer::stateChanged, this, [this] {
      if (!m_player.active())
         showFrame();
      updateActions();
      updateRun();
   });
}

void MainWindow::togglePlay()
{
   if (m_player.playing())
      m_player.pause();
   else if (m_session.hierarchy()) {
      forgetBalance();
      m_player.play(m_session.catalogue(), m_session.design(), m_session.hierarchy());
   }
}

void MainWindow::forgetBalance()
{
   if (!m_balance)
      return;
   m_balance = nullptr;
   showFrame();
   updateActions();
}

void MainWindow::showBalance()
{
   const auto hierarchy = m_session.hierarchy();
   if (!hierarchy)
      return;
   m_player.reset();
   auto result = std::make_shared<std::optional<Result<ShownBalance>>>();
   startTask(
       tr("Finding the balance"),
       [result, hierarchy, catalogue = m_session.catalogue(), design = m_session.design()](const Job &job) {
          result->emplace(findBalance(catalogue, design, *hierarchy, job));
       },
       [this, result, revision = m_session.revision()] {
          if (!result->value().ok())
             return showFailure(result->value().error());
          if (m_session.revision() != revision || m_player.active())
             return; // of a design before
          m_balance = std::make_shared<const ShownBalance>(std::move(**result).value());
          m_messages->showMessage(m_balance->told, false);
          showFrame();
          updateActions();
       });
}

void MainWindow::showFrame()
{
   const auto frame = m_balance ? m_balance->moment : m_player.frame();
   const bool coloured = m_actions["simulate.colour"]->isChecked();
   m_viewport->showFrame(frame, coloured);
   m_legend->setVisible(frame && coloured);
   if (frame && coloured)
      m_legend->setLegend(m_balance ? m_balance->legend
                                    : render::lengthLegend(tr("displacement").toStdString(), frame->highest));
   updateRun();
}

/// A changed design is at rest: the run was of the one before.
void MainWindow::editStarted()
{
   forgetBalance();
   if (!m_player.active())
      return;
   m_player.reset();
   m_messages->showMessage(tr("The design changed: the simulation is back at its start."), false);
}

void MainWindow::updateActions()
{
   QAction *undo = m_actions["edit.undo"], *redo = m_actions["edit.redo"];
   undo->setEnabled(m_session.canUndo());
   undo->setText(m_session.canUndo() ? tr("&Undo %1").arg(m_session.undoText()) : tr("Nothing to Undo"));
   redo->setEnabled(m_session.canRedo());
   redo->setText(m_session.canRedo() ? tr("&Redo %1").arg(m_session.redoText()) : tr("Nothing to Redo"));
   const bool region = m_viewport->builder().region().has_value();
   m_actions["edit.fill"]->setEnabled(region);
   m_actions["edit.eraseRegion"]->setEnabled(region);
   m_actions["edit.place"]->setEnabled(m_viewport->ghost().cell.has_value());
   m_actions["simulate.play"]->setText(m_player.playing() ? tr("&Pause") : tr("&Play"));
   m_actions["simulate.reset"]->setEnabled(m_player.active() || m_balance);
   setWindowTitle(QStringLiteral("%1[*] - Diatom").arg(m_session.title()));
   setWindowModified(m_session.modified());
}

void MainWindow::updateCounts()
{
   if (!m_session.hierarchy()) {
      m_counts->clear();
      return;
   }
   const auto perMaterial = m_session.hierarchy()->countByMaterial();
   const auto used = std::count_if(perMaterial.begin(), perMaterial.end(), [](auto n) { return n > 0; });
   const auto cells = m_session.hierarchy()->cells();
   const auto &materials = *m_session.design().model.materials;
   const auto known =
       std::count_if(materials.begin(), materials.end(), [](const Material &m) { return !m.id.empty(); });
   const QString number = QLocale().toString(static_cast<qulonglong>(cells));
   m_counts->setText((cells == 1 ? tr("%1 cell, %2 of %3 materials") : tr("%1 cells, %2 of %3 materials"))
                         .arg(number)
                         .arg(used)
                         .arg(known));
}

void MainWindow::updateRun()
{
   const auto frame = m_player.frame();
   if (!frame) {
      m_run->setText(m_balance ? tr("in balance") : m_player.active() ? tr("preparing") : tr("at rest"));
      return;
   }
   QString text = tr("t %1 s").arg(frame->frame.time, 0, 'f', 3);
   text +=
       frame->realTimeFactor > 0 ? tr(", %1x real time").arg(frame->realTimeFactor, 0, 'g', 3) : QString();
   m_run->setText(m_player.playing()    ? text
                  : m_player.finished() ? text + tr(", finished")
                                        : text + tr(", paused"));
}

void MainWindow::placeOverlays()
{
   m_legend->move(m_viewport->width() - m_legend->width() - 12, 12);
   m_hint->setVisible(!m_hint->text().isEmpty());
   m_hint->adjustSize();
   m_hint->move((m_viewport->width() - m_hint->width()) / 2, m_viewport->height() - m_hint->height() - 12);
}

bool MainWindow::eventFilter(QObject *watched, QEvent *event)
{
   if (watched == m_viewport && event->type() == QEvent::Resize)
      placeOverlays();
   return QMainWindow::eventFilter(watched, event);
}

void MainWindow::resizeEvent(QResizeEvent *event)
{
   QMainWindow::resizeEvent(event);
   placeOverlays();
}

void MainWindow::closeEvent(QCloseEvent *event)
{
   if (!mayDiscard()) {
      event->ignore();
      return;
   }
   m_player.reset();
   if (m_settings) {
      m_settings->setValue("window/geometry", saveGeometry());
      m_settings->setValue("window/state", saveState(kLayoutVersion));
      m_settings->setValue("simulationPanel/page", m_panel->currentIndex());
   }
   event->accept();
}

} // namespace diatom::gui
