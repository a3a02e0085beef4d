#include "gui/actions.h"

#include "gui/icons.h"

#include <QActionGroup>
#include <QCoreApplication>

namespace diatom::gui {

namespace {

#define TR(text) QT_TRANSLATE_NOOP("Actions", text)
constexpr auto kToggle = ActionInfo::toggle;
constexpr auto kTool = ActionInfo::tool;
constexpr auto kPlain = ActionInfo::plain;

constexpr ActionInfo kTable[] = {
    {"file.open", "file", TR("&Open..."), "Ctrl+O",
     TR("Open a design or a file of another program, or fill a mesh with cells")},
    {"file.save", "-file", TR("&Save"), "Ctrl+S", TR("Save the design")},
    {"file.saveAs", "file", TR("Save &As..."), "Ctrl+Shift+S", TR("Save the design under another name")},
    {"file.export", "file", TR("&Export..."), "Ctrl+E",
     TR("Write cells, parts or struts as STL, 3MF, OBJ, PLY or glTF, or a file of another program")},
    {"file.quit", "-file", TR("&Quit"), "Ctrl+Q", TR("Close the program")},

    {"edit.undo", "edit", TR("&Undo"), "Ctrl+Z", TR("Take the last edit back")},
    {"edit.redo", "edit", TR("&Redo"), "Ctrl+Shift+Z", TR("Do the edit again that was taken back")},
    {"edit.place", "-edit", TR("Place &Cell Here"), "Insert",
     TR("Act with the tool on the port under the pointer"), kPlain, true},
    {"edit.fill", "edit", TR("&Fill Region"), "Return", TR("Fill the region with the material in hand"),
     kPlain, true},
    {"edit.eraseRegion", "edit", TR("&Erase Region"), "Del", TR("Erase all cells of the region"), kPlain,
     true},
    {"edit.cancel", "edit", TR("&Drop Region"), "Esc", TR("Forget the region and close messages")},
    {"tool.place", "-edit", TR("&Place"), "B", TR("Place cells on the port under the pointer"), kTool},
    {"tool.erase", "edit", TR("&Erase"), "D", TR("Erase the cell under the pointer"), kTool},
    {"tool.paint", "edit", TR("Pai&nt"), "G", TR("Give the cell under the pointer the material in hand"),
     kTool},
    {"tool.pick", "edit", TR("P&ick Material"), "I",
     TR("Take the material of the cell under the pointer in hand"), kTool},

    {"view.iso", "view", TR("&Oblique"), "Alt+1", TR("Look from an upper corner")},
    {"view.front", "view", TR("&Front"), "Alt+2", TR("Look along Y")},
    {"view.back", "view", TR("&Back"), "Alt+3", TR("Look against Y")},
    {"view.left", "view", TR("&Left"), "Alt+4", TR("Look along X")},
    {"view.right", "view", TR("&Right"), "Alt+5", TR("Look against X")},
    {"view.top", "view", TR("&Top"), "Alt+6", TR("Look down")},
    {"view.bottom", "view", TR("Botto&m"), "Alt+7", TR("Look up")},
    {"view.fit", "view", TR("F&it"), "Home", TR("Show the whole assembly")},
    {"view.orthographic", "view", TR("Ort&hographic"), "Num+5", TR("Draw without perspective"), kToggle},
    {"view.cells", "-view", TR("&Cells"), "V", TR("Show every cell")},
    {"view.hierarchy", "view", TR("&Hierarchy"), "H", TR("Show composites as boxes")},
    {"view.parts", "view", TR("&Parts"), "P", TR("Show the parts that the cells are made of")},
    {"view.struts", "view", TR("&Struts"), "Shift+P", TR("Show the edges of the cells as struts")},
    {"view.grid", "view", TR("Base &Plane"), "Ctrl+G", TR("Show the lattice's tiling on the base plane"),
     kToggle},

    {"simulate.play", "simulate", TR("&Play"), "Space", TR("Start or pause the simulation")},
    {"simulate.reset", "simulate", TR("&Back to Start"), "Backspace",
     TR("Stop the simulation and return to rest")},
    {"simulate.balance", "simulate", TR("Find Ba&lance"), "Ctrl+B",
     TR("Show where the design comes to rest under its loads, or the steady state of another physics")},
    {"simulate.colour", "-simulate", TR("&Colour by Displacement"), "C",
     TR("Show how far each cell has moved, or what else the solver tells"), kToggle},
    {"simulate.panel", "-simulate", TR("&Simulation Panel"), "F8",
     TR("Show which effects are simulated and what accuracy costs"), kToggle},

    {"help.keys", "help", TR("&Keys"), "F1", TR("List all keys")},
    {"help.plugins", "help", TR("&Plugins…"), "", TR("Every plugin found, with its verdict")},
    {"help.about", "help", TR("&About Diatom"), "", TR("Version and licence")}};
#undef TR

} // namespace

std::span<const ActionInfo> actionTable() { return kTable; }

Actions::Actions(QObject *parent) : QObject(parent), m_tools(new QActionGroup(this))
{
   for (const ActionInfo &info : kTable) {
      auto *action = new QAction(QCoreApplication::translate("Actions", info.text), this);
      action->setObjectName(QString::fromUtf8(info.id));
      action->setIcon(actionIcon(info.id));
      QString tip = QCoreApplication::translate("Actions", info.tip);
      if (*info.key) {
         action->setShortcut(QKeySequence(QString::fromUtf8(info.key)));
         tip += QStringLiteral(" (%1)").arg(action->shortcut().toString(QKeySequence::NativeText));
      }
      action->setToolTip(tip);
      action->setStatusTip(tip);
      action->setCheckable(info.kind != ActionInfo::plain);
      if (info.kind == ActionInfo::tool)
         m_tools->addAction(action);
      m_actions[info.id] = action;
   }
   // Second keys people know.
   m_actions["edit.redo"]->setShortcuts(
       {m_actions["edit.redo"]->shortcut(), QKeySequence(Qt::CTRL | Qt::Key_Y)});
   m_actions["edit.fill"]->setShortcuts({Qt::Key_Return, Qt::Key_Enter});
}

void Actions::addTo(QMenu *menu, std::string_view name) const
{
   for (const ActionInfo &info : kTable) {
      std::string_view place = info.menu;
      const bool apart = place.substr(0, 1) == "-";
      place.remove_prefix(apart ? 1 : 0);
      if (place != name)
         continue;
      if (apart)
         menu->addSeparator();
      menu->addAction(m_actions.at(info.id));
   }
}

} // namespace diatom::gui
