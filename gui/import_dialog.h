// "Fill a mesh with cells": of which lattice and size, and about how many that makes, before it is done.
#pragma once

#include "formats/import_mesh.h"
#include "formats/mesh_facts.h"

#include <QDialog>

#include <memory>
#include <optional>

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QPushButton;

namespace diatom::gui {

struct ImportRequest
{
   MeshImport mesh;
   std::shared_ptr<const Lattice> lattice;
};

class ImportDialog : public QDialog
{
   Q_OBJECT

public:
   ImportDialog(std::shared_ptr<const Catalogue> catalogue, const QString &file, const MeshFacts &facts,
                QWidget *parent);

   /// Nothing where the sentence that is shown says why.
   const std::optional<ImportRequest> &request() const { return m_request; }

private:
   double unit() const;
   void addChoices();
   void refresh();

   std::shared_ptr<const Catalogue> m_catalogue;
   MeshFacts m_facts;
   std::optional<ImportRequest> m_request;
   QComboBox *m_lattice, *m_unit, *m_rule;
   QLineEdit *m_pitch, *m_material;
   QDoubleSpinBox *m_fraction;
   QLabel *m_size, *m_about;
   QPushButton *m_fill;
};

} // namespace diatom::gui
