// The open document with its file, its hierarchy and the material in hand. Every change of the design goes
// through run(), which is a command of the kernel's table; widgets only watch.
#pragma once

#include "cells/hierarchy.h"
#include "document/document.h"
#include "formats/files.h"

#include <QObject>
#include <QString>

#include <cstdint>
#include <filesystem>
#include <memory>

namespace diatom::gui {

class Session : public QObject
{
   Q_OBJECT

public:
   explicit Session(std::shared_ptr<const Catalogue> catalogue, QObject *parent = nullptr);

   const std::shared_ptr<const Catalogue> &catalogue() const { return m_catalogue; }
   const Design &design() const { return m_document->design(); }
   /// Null when the design's lattice is not installed.
   const std::shared_ptr<const Hierarchy> &hierarchy() const { return m_hierarchy; }
   /// Empty for a design that was never saved.
   const std::filesystem::path &file() const { return m_file; }
   QString title() const;
   bool modified() const { return m_document->modified(); }
   QString undoText() const { return QString::fromStdString(m_document->undoText()); }
   QString redoText() const { return QString::fromStdString(m_document->redoText()); }
   bool canUndo() const { return m_document->canUndo(); }
   bool canRedo() const { return m_document->canRedo(); }
   QString stateHash() const;
   /// Counts edits, undo and redo among them.
   std::uint64_t revision() const { return m_revision; }

   /// 0 when the design has no materials.
   MaterialIndex material() const { return m_material; }
   void setMaterial(MaterialIndex material);

   void newDesign(const std::string &lattice);
   /// Takes a design that was read; an imported one has no file of its own to be saved to.
   void take(Opened opened, const std::filesystem::path &file);
   bool save(const std::filesystem::path &file);
   /// False, with failed() raised, when nothing was changed.
   bool run(const char *command, const nlohmann::json &arguments);
   /// For who shows faults himself: the sentence when nothing was changed, else "".
   QString tryRun(const char *command, const nlohmann::json &arguments);
   void undo();
   void redo();

signals:
   void designChanged();  // content: draw again
   void designReplaced(); // another document: look at it afresh
   void fileChanged();    // saved: the title, not the content
   void materialChanged();
   void failed(const QString &message);
   void noted(const QString &message);

private:
   void replace(Design design);
   void refresh();

   std::shared_ptr<const Catalogue> m_catalogue;
   std::unique_ptr<Document> m_document;
   std::shared_ptr<const Hierarchy> m_hierarchy;
   std::filesystem::path m_file;
   MaterialIndex m_material = 0;
   std::uint64_t m_revision = 0;
};

} // namespace diatom::gui
