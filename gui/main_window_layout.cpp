// What the window is made of: docks, menus, tool column and status bar.
#include "gui/main_window.h"

#include <QDockWidget>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QStatusBar>
#include <QToolBar>

#include <algorithm>

namespace diatom::gui {

/// Docks do not float: on Wayland they could not be put back (QTBUG-87332).
void MainWindow::makeDocks()
{
   m_hotbar = new Hotbar(&m_session, this);
   auto *materials = new QDockWidget(tr("Materials"), this);
   materials->setObjectName(QStringLiteral("materialsDock"));
   materials->setFeatures(QDockWidget::DockWidgetMovable);
   materials->setWidget(m_hotbar);
   addDockWidget(Qt::RightDockWidgetArea, materials);

   m_panel = new SimulationPanel(&m_session, &m_player, this);
   m_panelDock = new QDockWidget(tr("Simulation"), this);
   m_panelDock->setObjectName(QStringLiteral("simulationDock"));
   m_panelDock->setFeatures(QDockWidget::DockWidgetMovable | QDockWidget::DockWidgetClosable);
   m_panelDock->setWidget(m_panel);
   addDockWidget(Qt::RightDockWidgetArea, m_panelDock);
   m_panelDock->hide();
}

void MainWindow::makeMenus()
{
   struct Menu
   {
      const char *id;
      QString title;
   };
   for (const auto &[id, title] :
        {Menu{"file", tr("&File")}, Menu{"edit", tr("&Edit")}, Menu{"view", tr("&View")},
         Menu{"simulate", tr("&Simulate")}, Menu{"help", tr("&Help")}})
   {
      QMenu *menu = menuBar()->addMenu(title);
      menu->setObjectName(QStringLiteral("menu.%1").arg(QString::fromUtf8(id)));
      menu->setToolTipsVisible(true);
      if (std::string_view(id) == "file") {
         makeNewMenu(menu);
         makeSamplesMenu(menu);
         m_references = new ReferenceMenu(&m_session, m_viewport, menu);
         menu->addMenu(m_references);
         makeMachineMenu(menu);
      }
      m_actions.addTo(menu, id);
   }
}

void MainWindow::makeNewMenu(QMenu *file)
{
   QMenu *menu = file->addMenu(tr("&New"));
   menu->setObjectName(QStringLiteral("menu.new"));
   bool first = true;
   for (const Offer &offer : m_session.catalogue()->offers(DIATOM_LATTICE_1)) {
      const std::string id = offer.provided->id;
      QAction *action = menu->addAction(QString::fromStdString(offer.provided->name));
      action->setObjectName(QStringLiteral("file.new.") + QString::fromStdString(id));
      action->setToolTip(QString::fromStdString(offer.provided->summary));
      if (first || id == LatticeSpec{}.id) {
         for (QAction *other : menu->actions())
            other->setShortcut({});
         action->setShortcut(QKeySequence::New);
      }
      first = false;
      connect(action, &QAction::triggered, this, [this, id] {
         if (mayDiscard())
            m_session.newDesign(id);
      });
   }
}

void MainWindow::makeSamplesMenu(QMenu *file)
{
   QMenu *menu = file->addMenu(tr("Sa&mples"));
   menu->setObjectName(QStringLiteral("menu.samples"));
   for (const auto &folder : sampleFolders()) {
      std::error_code error;
      std::vector<std::filesystem::path> files;
      for (const auto &entry : std::filesystem::directory_iterator(folder, error))
         if (entry.path().extension() == ".diatom")
            files.push_back(entry.path());
      std::sort(files.begin(), files.end());
      for (const auto &path : files) {
         QString name = QString::fromStdString(path.stem().string());
         name.replace(QLatin1Char('_'), QLatin1Char(' ')).replace(QLatin1Char('-'), QLatin1Char(' '));
         name[0] = name[0].toUpper();
         QAction *action = menu->addAction(name);
         action->setObjectName(QStringLiteral("file.sample.") + QString::fromStdString(path.stem().string()));
         action->setToolTip(tr("Open the sample %1").arg(name));
         connect(action, &QAction::triggered, this, [this, path] {
            if (mayDiscard())
               open(path);
         });
      }
      if (!files.empty())
         break;
   }
   menu->setEnabled(!menu->isEmpty());
}

void MainWindow::makeMachineMenu(QMenu *file)
{
   QMenu *menu = file->addMenu(tr("&Machine Program"));
   menu->setObjectName(QStringLiteral("menu.machines"));
   for (const Offer &offer : m_session.catalogue()->offers(DIATOM_MACHINE_1)) {
      const std::string id = offer.provided->id;
      QAction *action = menu->addAction(tr("%1…").arg(QString::fromStdString(offer.provided->name)));
      action->setObjectName(QStringLiteral("file.machine.") + QString::fromStdString(id));
      action->setToolTip(tr("Plan the assembly and write the program: %1")
                             .arg(QString::fromStdString(offer.provided->summary)));
      connect(action, &QAction::triggered, this, [this, id] { writeProgram(id); });
   }
   menu->setEnabled(!menu->isEmpty());
}

void MainWindow::makeToolColumn()
{
   auto *bar = new QToolBar(tr("Tools"), this);
   bar->setObjectName(QStringLiteral("toolColumn"));
   bar->setIconSize({26, 26});
   for (const char *id : {"tool.place", "tool.erase", "tool.paint", "tool.pick"})
      bar->addAction(m_actions[id]);
   bar->addSeparator();
   bar->addAction(m_actions["simulate.play"]);
   bar->addAction(m_actions["simulate.reset"]);
   bar->addSeparator();
   bar->addAction(m_actions["simulate.panel"]);
   addToolBar(Qt::LeftToolBarArea, bar);
   m_actions["tool.place"]->setChecked(true);
   m_actions["view.grid"]->setChecked(true);
   m_actions["simulate.colour"]->setChecked(true);
}

void MainWindow::makeStatusBar()
{
   const auto label = [this](const char *name, const QString &meaning) {
      auto *made = new QLabel(this);
      made->setObjectName(QString::fromUtf8(name));
      made->setToolTip(meaning);
      return made;
   };
   m_address = label("status.address", tr("Cell and port under the pointer"));
   m_counts = label("status.counts", tr("Cells and materials of the design"));
   m_run = label("status.run", tr("Simulated time, and how it compares with real time"));
   m_speed = label("status.speed", tr("Time to draw the last picture"));
   m_task = new TaskRow(this);
   statusBar()->addWidget(m_address, 1);
   for (QWidget *widget : {static_cast<QWidget *>(m_task), static_cast<QWidget *>(m_counts),
                           static_cast<QWidget *>(m_run), static_cast<QWidget *>(m_speed)})
      statusBar()->addPermanentWidget(widget);
}

} // namespace diatom::gui
