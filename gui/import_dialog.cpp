#include "gui/import_dialog.h"

#include "core/lengths.h"
#include "gui/readable.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QPushButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>

namespace diatom::gui {

namespace {

/// Above this it takes minutes and gigabytes.
constexpr double kManyCells = 5e7;

/// 1, 2 or 5 times a power of ten, at or above the value.
double roundUp(double value)
{
   const double power = std::pow(10, std::floor(std::log10(value)));
   for (const double digit : {1.0, 2.0, 5.0})
      if (digit * power >= value)
         return digit * power;
   return 10 * power;
}

/// A count as an estimate has it: two digits that count.
QString roughly(double count)
{
   if (count < 100)
      return QLocale().toString(std::round(count), 'f', 0);
   const double power = std::pow(10, std::floor(std::log10(count)) - 1);
   return QLocale().toString(std::round(count / power) * power, 'f', 0);
}

} // namespace

ImportDialog::ImportDialog(std::shared_ptr<const Catalogue> catalogue, const QString &file,
                           const MeshFacts &facts, QWidget *parent)
    : QDialog(parent), m_catalogue(std::move(catalogue)), m_facts(facts), m_lattice(new QComboBox(this)),
      m_unit(new QComboBox(this)), m_rule(new QComboBox(this)), m_pitch(new QLineEdit(this)),
      m_material(new QLineEdit(this)), m_fraction(new QDoubleSpinBox(this)), m_size(new QLabel(this)),
      m_about(new QLabel(this))
{
   setObjectName(QStringLiteral("importDialog"));
   setWindowTitle(tr("Fill a Mesh with Cells"));
   addChoices();
   QString what =
       tr("%1: %2 triangles").arg(file, QLocale().toString(static_cast<qulonglong>(facts.triangles)));
   if (!facts.faults.empty())
      what += QStringLiteral("; ") + QString::fromStdString(facts.faults);
   auto *mesh = new QLabel(what, this);
   mesh->setObjectName(QStringLiteral("import.mesh"));
   auto *form = new QFormLayout;
   form->addRow(tr("&Lattice"), m_lattice);
   form->addRow(tr("&Pitch"), m_pitch);
   form->addRow(tr("&Unit of the file"), m_unit);
   form->addRow(tr("Size"), m_size);
   form->addRow(tr("&Boundary"), m_rule);
   form->addRow(tr("P&art of a cell"), m_fraction);
   form->addRow(tr("&Material"), m_material);
   auto *buttons = new QDialogButtonBox(QDialogButtonBox::Cancel, this);
   m_fill = buttons->addButton(tr("&Fill"), QDialogButtonBox::AcceptRole);
   m_fill->setObjectName(QStringLiteral("import.fill"));
   m_fill->setDefault(true);
   for (QLabel *label : {mesh, m_about}) {
      label->setWordWrap(true);
      label->setTextFormat(Qt::PlainText);
   }
   auto *layout = new QVBoxLayout(this);
   layout->addWidget(mesh);
   layout->addLayout(form);
   layout->addWidget(m_about);
   layout->addWidget(buttons);
   setMinimumWidth(440);

   for (QComboBox *box : {m_lattice, m_unit, m_rule})
      connect(box, &QComboBox::currentIndexChanged, this, &ImportDialog::refresh);
   for (QLineEdit *line : {m_pitch, m_material})
      connect(line, &QLineEdit::textChanged, this, &ImportDialog::refresh);
   connect(m_fraction, &QDoubleSpinBox::valueChanged, this, &ImportDialog::refresh);
   connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
   connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
   refresh();
}

void ImportDialog::addChoices()
{
   const auto name = [](QWidget *widget, const char *id, const QString &accessible) {
      widget->setObjectName(QString::fromUtf8(id));
      widget->setAccessibleName(accessible);
   };
   name(m_lattice, "import.lattice", tr("Lattice of the cells"));
   for (const Offer &offer : m_catalogue->offers(DIATOM_LATTICE_1))
      m_lattice->addItem(QString::fromStdString(offer.provided->name),
                         QString::fromStdString(offer.provided->id));
   m_lattice->setCurrentIndex(std::max(0, m_lattice->findData(QString::fromStdString(LatticeSpec{}.id))));
   name(m_unit, "import.unit", tr("What a number of the file stands for"));
   m_unit->addItem(tr("as the file says or its format has it (%1)").arg(lengthText(m_facts.customaryUnit)),
                   m_facts.customaryUnit);
   for (const auto &[unit, metres] : kLengthUnits)
      m_unit->addItem(QString::fromUtf8(unit.data(), static_cast<int>(unit.size())), metres);
   name(m_rule, "import.rule", tr("Which cells of the boundary belong"));
   m_rule->addItem(tr("Cells whose centre is inside"), static_cast<int>(BoundaryRule::centre));
   m_rule->addItem(tr("Cells that it touches at all"), static_cast<int>(BoundaryRule::touch));
   m_rule->addItem(tr("Cells of which a part is inside"), static_cast<int>(BoundaryRule::fraction));
   name(m_fraction, "import.fraction", tr("Part of a cell that must be inside"));
   m_fraction->setRange(1.0 / 64, 1);
   m_fraction->setSingleStep(0.1);
   m_fraction->setValue(MeshImport{}.fraction);
   name(m_pitch, "import.pitch", tr("Length of a lattice unit"));
   m_pitch->setToolTip(tr("Length of a lattice unit, such as 2 mm: the edge of a cube"));
   const double longest = m_facts.size.maxCoeff() * m_facts.customaryUnit;
   m_pitch->setText(lengthText(longest > 0 ? roundUp(longest / 30) : 1e-3));
   name(m_material, "import.material", tr("Id of the material"));
   m_material->setPlaceholderText(m_facts.pieces > 1 ? tr("one for each piece or colour of the mesh")
                                                     : tr("named after the mesh"));
   m_size->setObjectName(QStringLiteral("import.size"));
   m_about->setObjectName(QStringLiteral("import.about"));
}

double ImportDialog::unit() const { return m_unit->currentData().toDouble(); }

void ImportDialog::refresh()
{
   const Vec3 size = unit() * m_facts.size;
   m_size->setText(tr("%1 x %2 x %3").arg(lengthText(size.x()), lengthText(size.y()), lengthText(size.z())));
   const auto rule = static_cast<BoundaryRule>(m_rule->currentData().toInt());
   m_fraction->setEnabled(rule == BoundaryRule::fraction);
   m_request.reset();
   const auto pitch = parseLength(m_pitch->text().trimmed().toStdString(), 1e-3);
   QString words;
   if (!pitch) {
      words = tr("\"%1\" is no pitch: write a length above 0 such as 2 mm.").arg(m_pitch->text());
   } else {
      LatticeSpec spec;
      spec.id = m_lattice->currentData().toString().toStdString();
      spec.pitch = *pitch;
      const Job job;
      auto lattice = Lattice::make(*m_catalogue, spec, job);
      if (lattice) {
         const double cells = cellsAbout(m_facts, unit(), rule, **lattice);
         words = tr("That makes about %1 cells.").arg(roughly(cells));
         if (cells < 0.5)
            words += QLatin1Char(' ') + tr("Choose a smaller pitch or another unit.");
         else if (cells > kManyCells)
            words += QLatin1Char(' ') + tr("So many take long and much memory.");
         ImportRequest request;
         request.mesh.unit = unit();
         request.mesh.rule = rule;
         request.mesh.fraction = m_fraction->value();
         request.mesh.material = m_material->text().trimmed().toStdString();
         request.lattice = *std::move(lattice);
         m_request = std::move(request);
      } else {
         words = QString::fromStdString(lattice.error().message);
      }
   }
   m_about->setText(words);
   m_fill->setEnabled(m_request.has_value());
}

} // namespace diatom::gui
