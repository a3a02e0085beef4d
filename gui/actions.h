// The one table of what a user can do. Menus, keys, the tool column, the key sheet and the tests are made
// from it.
#pragma once

#include <QAction>
#include <QMenu>
#include <QObject>

#include <map>
#include <span>
#include <string_view>

namespace diatom::gui {

struct ActionInfo
{
   const char *id;   // object name, stable: "edit.undo"
   const char *menu; // "file", "edit", "view", "simulate", "help"; a leading '-' puts a separator in front
   const char *text; // with the menu letter
   const char *key;  // "" = none
   const char *tip;  // one sentence
   enum Kind { plain, toggle, tool } kind = plain;
   bool edits = false; // changes the design, so that undo must take it back
};

/// All of them, in menu order. Entries made at run time (lattices, samples, materials) are added by the main
/// window.
std::span<const ActionInfo> actionTable();

/// The QActions of the table, with texts, keys, tooltips and object names.
class Actions : public QObject
{
   Q_OBJECT

public:
   explicit Actions(QObject *parent);
   QAction *operator[](std::string_view id) const { return m_actions.at(id); }
   /// Appends the actions of a menu.
   void addTo(QMenu *menu, std::string_view name) const;

private:
   std::map<std::string_view, QAction *> m_actions;
   QActionGroup *m_tools;
};

} // namespace diatom::gui
