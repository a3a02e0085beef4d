// What to write of a design, in which format and where: everything that the command line's export and convert
// offer for files of other programs.
#pragma once

#include "formats/foreign.h"
#include "gui/session.h"
#include "io/export_files.h"

#include <QDialog>

#include <optional>

class QComboBox;
class QLabel;
class QLineEdit;
class QPushButton;

namespace diatom::gui {

struct ExportRequest
{
   std::filesystem::path file;
   const ForeignFormat *foreign = nullptr; // another program's cells; else geometry
   ExportOptions options;
   std::string parts; // the plugin's id
};

class ExportDialog : public QDialog
{
   Q_OBJECT

public:
   /// `folder` is where the file is proposed to go.
   ExportDialog(const Session &session, const QString &folder, QWidget *parent);

   /// What was chosen; the sentence that is shown says why nothing where it is.
   std::optional<ExportRequest> request() const;

private:
   struct Format
   {
      QString name, suffix;
      std::optional<GeometryFormat> geometry;
      const ForeignFormat *foreign = nullptr;
   };
   void addWhats(const Session &session);
   void addFormats();
   const Format &format() const;
   void formatChosen();
   void fileTyped(const QString &text);
   void browse();
   QString fault() const;
   QString note() const;
   void refresh();

   std::vector<Format> m_formats;
   QComboBox *m_what, *m_format, *m_solids, *m_unit;
   QLineEdit *m_width, *m_file;
   QLabel *m_words;
   QPushButton *m_write;
};

} // namespace diatom::gui
