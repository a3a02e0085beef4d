// The studio's window: menus and tool column from the action table, viewport, hotbar, status bar, and the
// wiring.
#pragma once

#include "gui/actions.h"
#include "gui/balance.h"
#include "gui/hotbar.h"
#include "gui/legend_widget.h"
#include "gui/message_bar.h"
#include "gui/reference_menu.h"
#include "gui/session.h"
#include "gui/simulation_panel.h"
#include "gui/simulation_player.h"
#include "gui/task_row.h"
#include "gui/viewport.h"
#include "io/geometry.h"

#include <QMainWindow>
#include <QSettings>

#include <filesystem>
#include <string_view>

class QDockWidget;
class QLabel;

namespace diatom::gui {

struct ExportRequest;
struct ImportRequest;

class MainWindow : public QMainWindow
{
   Q_OBJECT

public:
   /// `settings` may be null: nothing is remembered then.
   MainWindow(std::shared_ptr<const Catalogue> catalogue, QSettings *settings, QWidget *parent = nullptr);
   ~MainWindow() override;

   Session &session() { return m_session; }
   Viewport &viewport() { return *m_viewport; }
   SimulationPlayer &player() { return m_player; }
   bool busy() const { return m_task->busy(); }
   /// In the background; the window shows it when it is read. For a mesh it first asks of which cells.
   void open(const std::filesystem::path &file);

   /// What a plugin did that it must not, or anything else worth a line over the view.
   void warn(const QString &text) { m_messages->showMessage(text, false); }

   /// Folders with samples: beside an installed program and in the source tree.
   static std::vector<std::filesystem::path> sampleFolders();

protected:
   void closeEvent(QCloseEvent *event) override;
   void resizeEvent(QResizeEvent *event) override;
   bool eventFilter(QObject *watched, QEvent *event) override;

private:
   void makeMenus();
   void makeNewMenu(QMenu *file);
   void makeSamplesMenu(QMenu *file);
   void makeMachineMenu(QMenu *file);
   void makeToolColumn();
   void makeDocks();
   void makeStatusBar();
   void connectActions();
   void connectViews();

   bool mayDiscard();
   void chooseAndOpen();
   bool save(bool elsewhere);
   void chooseExport();
   void exportTo(const ExportRequest &request);
   /// Asks where to, plans the assembly and writes the machine's program in the background.
   void writeProgram(const std::string &machine);
   void openMesh(const std::filesystem::path &file);
   void fillMesh(const std::filesystem::path &file, const ImportRequest &request);
   /// False, with a message, while other work is going on.
   bool startTask(const QString &name, std::function<void(const Job &)> work, std::function<void()> done);
   void showFailure(const Error &error);
   /// What was read takes the place of the design; when that was edited since `agreed`, the user is asked.
   void takeRead(Result<Opened> read, const std::filesystem::path &file, std::uint64_t agreed);
   /// Parts or struts, in the background.
   void showAs(GeometryOptions::What what);
   void togglePlay();
   void showBalance();
   void forgetBalance();
   void showFrame();
   void editStarted();
   void showKeys();
   void showAbout();
   void updateActions();
   void updateCounts();
   void updateRun();
   void placeOverlays();
   void on(std::string_view action, std::function<void()> act);
   /// Where a file for this purpose was last; else where the design is, else the home folder.
   QString lastFolder(const char *purpose) const;
   void rememberFolder(const char *purpose, const QString &file);

   QSettings *m_settings;
   Session m_session;
   SimulationPlayer m_player;
   std::shared_ptr<const ShownBalance> m_balance; // shown while there is no run; null = none
   Actions m_actions;
   MessageBar *m_messages;
   Viewport *m_viewport;
   ReferenceMenu *m_references = nullptr;
   Hotbar *m_hotbar;
   SimulationPanel *m_panel;
   QDockWidget *m_panelDock;
   LegendWidget *m_legend;
   QLabel *m_hint;
   QLabel *m_address, *m_counts, *m_run, *m_speed;
   TaskRow *m_task;
};

} // namespace diatom::gui
