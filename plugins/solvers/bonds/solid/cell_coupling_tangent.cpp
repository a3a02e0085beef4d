// Second derivative of the energy: how the stresses follow the strains, and how the bonds turn under tension.
#include "solid/cell_coupling.h"

namespace bonds {

namespace {

using Row = std::array<double, 6>;

void put(Row &row, int first, Vec3 v, int axis)
{
   row[first + axis % 3] = v.x;
   row[first + (axis + 1) % 3] = v.y;
   row[first + (axis + 2) % 3] = v.z;
}

/// Derivatives of a stretch by displacement and spin of its two cells, world axes.
std::array<Row, 2> rowsOf(const Stretch &s, int axis)
{
   std::array<Row, 2> rows{};
   put(rows[0], 0, -s.along, axis);
   put(rows[0], 3, s.turnA, axis);
   put(rows[1], 0, s.along, axis);
   put(rows[1], 3, s.turnB, axis);
   return rows;
}

/// Adds the bond's second derivative times its tension.
void addTurning(const BondEnds &ends, int axis, std::int64_t a, std::int64_t b, double tension,
                const AddBlock &add)
{
   const BondPoint point = bondGeometry(ends);
   double blocks[2][2][36];
   for (int from = 0; from < 2; ++from)
      for (int k = 0; k < 6; ++k) {
         double unit[6]{};
         unit[k] = 1;
         const Vec3 move{unit[0], unit[1], unit[2]}, turn{unit[3], unit[4], unit[5]};
         const bool isB = from == 1;
         const Stretch change =
             stretchChange(point, isB ? move : -move, isB ? Vec3{} : turn, isB ? turn : Vec3{});
         const int column = k / 3 * 3 + (axis + k % 3) % 3;
         const std::array<Row, 2> rows = rowsOf(change, axis);
         for (int to = 0; to < 2; ++to)
            for (int i = 0; i < 6; ++i)
               blocks[to][from][6 * i + column] = tension * rows[to][i];
      }
   const std::int64_t cell[2] = {a, b};
   for (int to = 0; to < 2; ++to)
      for (int from = 0; from < 2; ++from)
         add(cell[to], cell[from], blocks[to][from]);
}

/// How the mean strains of a cell depend on one cell near it. A neighbour has a part in one of them alone.
struct Part
{
   std::int64_t cell = 0;
   int axis = -1; // -1: all three
   std::array<Row, 3> mean{};
};

/// Adds the products of all parts through `k`.
void addProduct(const std::vector<Part> &parts, const Symmetric &k, const AddBlock &add)
{
   const double full[3][3] = {{k[0], k[5], k[4]}, {k[5], k[1], k[3]}, {k[4], k[3], k[2]}};
   for (const Part &column : parts) {
      std::array<Row, 3> stress{};
      for (int i = 0; i < 3; ++i)
         for (int j = 0; j < 3; ++j)
            for (int n = 0; n < 6; ++n)
               stress[i][n] += full[i][j] * column.mean[j][n];
      for (const Part &row : parts) {
         double block[36]{};
         for (int i = 0; i < 3; ++i)
            for (int n = 0; n < 36 && (row.axis < 0 || row.axis == i); ++n)
               block[n] += row.mean[i][n / 6] * stress[i][n % 6];
         add(row.cell, column.cell, block);
      }
   }
}

} // namespace

void CellCoupling::addProducts(const State &state, const std::vector<Symmetric> &matrix,
                               double Weight::*weight, const AddBlock &add) const
{
   std::vector<Part> parts;
   for (std::size_t i = 0; i < m_cell.size(); ++i) {
      const std::int64_t cell = m_cell[i];
      parts.assign(1, {cell, -1, {}});
      for (std::int64_t s = m_first[cell]; s < m_first[cell + 1]; ++s) {
         const std::int64_t n = m_slot[s] / 2;
         const int axis = axisOf(n);
         const bool isB = m_slot[s] & 1;
         const auto rows = rowsOf(stretchOf(endsAt(state, n)), axis);
         Part other{cellAt(m_slot[s] ^ 1), axis, {}};
         for (int k = 0; k < 6; ++k) {
            parts[0].mean[axis][k] += m_weight[isB][n].*weight * rows[isB][k];
            other.mean[axis][k] = m_weight[isB][n].*weight * rows[!isB][k];
         }
         parts.push_back(other);
      }
      addProduct(parts, matrix[i], add);
   }
}

void CellCoupling::addStiffness(const State &state, const RestShape *rest, const AddBlock &add) const
{
   addProducts(state, m_stiffness, &Weight::strain, add);
   const auto bonds = static_cast<std::int64_t>(m_bond.size());
   measure(state, rest, 0, bonds);
   strain(0, static_cast<std::int64_t>(m_cell.size()));
   for (std::int64_t n = 0; n < bonds; ++n)
      addTurning(endsAt(state, n), axisOf(n), m_assembly->a[m_bond[n]], m_assembly->b[m_bond[n]],
                 tensionOf(n, false), add);
}

void CellCoupling::addDamping(const State &state, const AddBlock &add) const
{
   if (m_damped)
      addProducts(state, m_loss, &Weight::rate, add);
}

} // namespace bonds
