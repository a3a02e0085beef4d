#include "gui/export_dialog.h"

#include "core/lengths.h"
#include "parts/fitting_parts.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

namespace diatom::gui {

namespace {

constexpr const char *kCells = "cells", *kEdges = "edges", *kConnections = "connections", *kBeams = "beams";
constexpr const char *kPartsOf = "parts:";
constexpr const char *kApart = "apart", *kOne = "one", *kFiles = "files";

QComboBox *comboOf(const char *name, const QString &accessible, QWidget *parent)
{
   auto *box = new QComboBox(parent);
   box->setObjectName(QString::fromUtf8(name));
   box->setAccessibleName(accessible);
   return box;
}

bool isGltf(GeometryFormat format) { return format == GeometryFormat::gltf || format == GeometryFormat::glb; }

} // namespace

ExportDialog::ExportDialog(const Session &session, const QString &folder, QWidget *parent)
    : QDialog(parent), m_what(comboOf("export.what", tr("What to write"), this)),
      m_format(comboOf("export.format", tr("Format"), this)),
      m_solids(comboOf("export.solids", tr("Materials"), this)),
      m_unit(comboOf("export.unit", tr("Unit of the file"), this)), m_width(new QLineEdit(this)),
      m_file(new QLineEdit(this)), m_words(new QLabel(this))
{
   setObjectName(QStringLiteral("exportDialog"));
   setWindowTitle(tr("Export"));
   addWhats(session);
   addFormats();
   m_solids->addItem(tr("A solid for each material"), QString::fromUtf8(kApart));
   m_solids->addItem(tr("One solid, no walls between materials"), QString::fromUtf8(kOne));
   m_solids->addItem(tr("A file for each material"), QString::fromUtf8(kFiles));
   for (const auto &[name, metres] : kLengthUnits)
      m_unit->addItem(QString::fromUtf8(name.data(), static_cast<int>(name.size())), metres);
   m_width->setObjectName(QStringLiteral("export.strutWidth"));
   m_width->setAccessibleName(tr("Width of struts"));
   m_width->setPlaceholderText(tr("chosen for the design"));
   m_width->setToolTip(tr("Diameter of struts, such as 0.4 mm; empty = a fifth of the shortest, if it fits"));
   m_file->setObjectName(QStringLiteral("export.file"));
   m_file->setAccessibleName(tr("File to write"));
   m_file->setMinimumWidth(360);
   const QString stem = QFileInfo(session.title()).completeBaseName();
   m_file->setText(QDir(folder).filePath(stem + format().suffix));
   m_words->setObjectName(QStringLiteral("export.words"));
   m_words->setWordWrap(true);
   m_words->setTextFormat(Qt::PlainText);

   auto *place = new QHBoxLayout;
   auto *browse = new QToolButton(this);
   browse->setObjectName(QStringLiteral("export.browse"));
   browse->setText(tr("Browse..."));
   place->addWidget(m_file, 1);
   place->addWidget(browse);
   auto *form = new QFormLayout;
   form->addRow(tr("&Write"), m_what);
   form->addRow(tr("F&ormat"), m_format);
   form->addRow(tr("&Materials"), m_solids);
   form->addRow(tr("&Unit"), m_unit);
   form->addRow(tr("Strut w&idth"), m_width);
   form->addRow(tr("&File"), place);
   if (auto *label = qobject_cast<QLabel *>(form->labelForField(place)))
      label->setBuddy(m_file);
   auto *buttons = new QDialogButtonBox(QDialogButtonBox::Cancel, this);
   m_write = buttons->addButton(tr("&Export"), QDialogButtonBox::AcceptRole);
   m_write->setObjectName(QStringLiteral("export.write"));
   m_write->setDefault(true);
   auto *layout = new QVBoxLayout(this);
   layout->addLayout(form);
   layout->addWidget(m_words);
   layout->addWidget(buttons);

   for (QComboBox *box : {m_what, m_solids, m_unit})
      connect(box, &QComboBox::currentIndexChanged, this, &ExportDialog::refresh);
   connect(m_format, &QComboBox::currentIndexChanged, this, &ExportDialog::formatChosen);
   connect(m_width, &QLineEdit::textChanged, this, &ExportDialog::refresh);
   connect(m_file, &QLineEdit::textEdited, this, &ExportDialog::fileTyped);
   connect(m_file, &QLineEdit::textChanged, this, &ExportDialog::refresh);
   connect(browse, &QToolButton::clicked, this, &ExportDialog::browse);
   connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
   connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
   refresh();
}

void ExportDialog::addWhats(const Session &session)
{
   m_what->addItem(tr("Cells"), QString::fromUtf8(kCells));
   const Job job;
   const Catalogue &catalogue = *session.catalogue();
   for (const auto &maker : fittingParts(catalogue, session.design().model.lattice.id, job)) {
      const Offer *offer = catalogue.offer(DIATOM_PARTS_1, maker->id());
      m_what->addItem(tr("Parts: %1").arg(QString::fromStdString(offer->provided->name)),
                      QString::fromUtf8(kPartsOf) + QString::fromStdString(maker->id()));
      m_what->setItemData(m_what->count() - 1, QString::fromStdString(offer->provided->summary),
                          Qt::ToolTipRole);
   }
   m_what->addItem(tr("Struts along the edges of cells"), QString::fromUtf8(kEdges));
   m_what->addItem(tr("Struts from cell to joined cell"), QString::fromUtf8(kConnections));
   m_what->addItem(tr("Struts as beams, without a surface (3MF only)"), QString::fromUtf8(kBeams));
}

void ExportDialog::addFormats()
{
   m_formats = {{tr("STL"), QStringLiteral(".stl"), GeometryFormat::stl},
                {tr("3MF"), QStringLiteral(".3mf"), GeometryFormat::threeMf},
                {tr("OBJ"), QStringLiteral(".obj"), GeometryFormat::obj},
                {tr("PLY"), QStringLiteral(".ply"), GeometryFormat::ply},
                {tr("glTF, text"), QStringLiteral(".gltf"), GeometryFormat::gltf},
                {tr("glTF, binary"), QStringLiteral(".glb"), GeometryFormat::glb}};
   for (const ForeignFormat &foreign : foreignFormats())
      m_formats.push_back({tr("Cells for %1").arg(QString::fromUtf8(foreign.program)),
                           QString::fromUtf8(foreign.suffix),
                           {},
                           &foreign});
   for (const Format &format : m_formats)
      m_format->addItem(tr("%1 (%2)").arg(format.name, format.suffix), format.suffix);
}

const ExportDialog::Format &ExportDialog::format() const
{
   return m_formats[static_cast<std::size_t>(m_format->currentIndex())];
}

/// The file follows the format.
void ExportDialog::formatChosen()
{
   const QFileInfo info(m_file->text());
   if (!info.completeBaseName().isEmpty())
      m_file->setText(QDir(info.path()).filePath(info.completeBaseName() + format().suffix));
   refresh();
}

/// The format follows a suffix that says which.
void ExportDialog::fileTyped(const QString &text)
{
   const std::filesystem::path path(text.toStdString());
   const auto geometry = geometryFormat(path);
   const ForeignFormat *foreign = foreignFormat("", path);
   for (std::size_t i = 0; i < m_formats.size(); ++i)
      if ((geometry && m_formats[i].geometry == geometry) || (foreign && m_formats[i].foreign == foreign)) {
         const QSignalBlocker quiet(m_format);
         m_format->setCurrentIndex(static_cast<int>(i));
      }
}

void ExportDialog::browse()
{
   const QString chosen = QFileDialog::getSaveFileName(
       this, tr("Export"), m_file->text(), tr("%1 (*%2);;All files (*)").arg(format().name, format().suffix),
       nullptr, QFileDialog::DontConfirmOverwrite);
   if (chosen.isEmpty())
      return;
   m_file->setText(chosen);
   fileTyped(chosen);
   refresh();
}

QString ExportDialog::fault() const
{
   const QFileInfo file(m_file->text());
   if (file.fileName().isEmpty() || file.isDir())
      return tr("Say which file to write.");
   const QString what = m_what->currentData().toString();
   if (format().geometry && what == QLatin1String(kBeams) && format().geometry != GeometryFormat::threeMf)
      return tr("Only 3MF knows beams: choose that format, or struts with a surface.");
   if (m_width->isEnabled() && !m_width->text().isEmpty() &&
       !parseLength(m_width->text().trimmed().toStdString(), m_unit->currentData().toDouble()))
      return tr("\"%1\" is no width of a strut: write a length such as 0.4 mm, or leave it empty.")
          .arg(m_width->text());
   return {};
}

QString ExportDialog::note() const
{
   const QFileInfo file(m_file->text());
   const QString solids = m_solids->currentData().toString();
   QStringList notes;
   if (format().geometry && solids == QLatin1String(kFiles))
      notes += tr("Each file has the id of its material in its name; those there already are replaced.");
   else if (file.exists())
      notes += tr("%1 is there already and will be replaced.").arg(file.fileName());
   if (format().geometry == GeometryFormat::stl && solids == QLatin1String(kApart))
      notes += tr("STL holds one solid without materials.");
   if (format().geometry && isGltf(*format().geometry))
      notes += tr("glTF is in metres.");
   return notes.join(QLatin1Char(' '));
}

void ExportDialog::refresh()
{
   const bool geometry = format().geometry.has_value();
   const QString what = m_what->currentData().toString();
   m_what->setEnabled(geometry);
   m_solids->setEnabled(geometry);
   m_unit->setEnabled(geometry && !isGltf(*format().geometry));
   m_width->setEnabled(geometry && (what == QLatin1String(kEdges) || what == QLatin1String(kConnections) ||
                                    what == QLatin1String(kBeams)));
   const QString wrong = fault();
   m_words->setText(wrong.isEmpty() ? note() : wrong);
   m_write->setEnabled(wrong.isEmpty());
}

std::optional<ExportRequest> ExportDialog::request() const
{
   if (!fault().isEmpty())
      return std::nullopt;
   ExportRequest request;
   QString file = m_file->text();
   if (QFileInfo(file).suffix().isEmpty())
      file += format().suffix;
   request.file = file.toStdString();
   request.foreign = format().foreign;
   if (request.foreign)
      return request;
   ExportOptions &options = request.options;
   options.format = *format().geometry;
   options.unit = isGltf(options.format) ? 1 : m_unit->currentData().toDouble();
   options.geometry.apart = m_solids->currentData().toString() != QLatin1String(kOne);
   options.eachMaterial = m_solids->currentData().toString() == QLatin1String(kFiles);
   const QString what = m_what->currentData().toString();
   if (what == QLatin1String(kCells))
      return request;
   if (what.startsWith(QLatin1String(kPartsOf))) {
      options.geometry.what = GeometryOptions::What::parts;
      request.parts = what.mid(static_cast<int>(qstrlen(kPartsOf))).toStdString();
      return request;
   }
   options.geometry.what = GeometryOptions::What::struts;
   options.geometry.struts.connections = what == QLatin1String(kConnections);
   options.geometry.struts.beams = what == QLatin1String(kBeams);
   if (!m_width->text().isEmpty())
      options.geometry.struts.width =
          *parseLength(m_width->text().trimmed().toStdString(), m_unit->currentData().toDouble());
   return request;
}

} // namespace diatom::gui
