// Building the coupling, and its energy and bounds at rest. Its forces are in cell_coupling_forces.cpp, its
// tangent in cell_coupling_tangent.cpp.
#include "solid/cell_coupling.h"

#include "model/bond_ends.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bonds {

namespace {

double at(const Symmetric &m, int i, int j) { return i == j ? m[i] : m[6 - i - j]; }

/// Every entry times scale[row] scale[column].
Symmetric scaled(const Symmetric &m, const std::array<double, 3> &scale)
{
   return {m[0] * scale[0] * scale[0], m[1] * scale[1] * scale[1], m[2] * scale[2] * scale[2],
           m[3] * scale[1] * scale[2], m[4] * scale[2] * scale[0], m[5] * scale[0] * scale[1]};
}

} // namespace

/// With n directions the compliance ((1 + nu) 1 - nu ones) / E has the inverse
/// E / (1 + nu) (1 + nu / (1 - (n - 1) nu) ones).
Symmetric poissonStiffness(double youngsModulus, double poissonRatio, double volume,
                           const std::array<double, 3> &reach)
{
   const double nu = poissonRatio, own = -nu / (1 + nu);
   Symmetric sum{};
   for (unsigned present = 1; present < 8; ++present) {
      double share = youngsModulus * volume;
      int directions = 0;
      for (unsigned k = 0; k < 3; ++k) {
         const bool here = present >> k & 1;
         share *= here ? reach[k] : 1 - reach[k];
         directions += here;
      }
      const double all = nu / ((1 + nu) * (1 - (directions - 1) * nu));
      for (unsigned k = 0; k < 3; ++k) {
         if (present >> k & 1)
            sum[k] += share * (own + all);
         if ((present >> (k + 1) % 3 & 1) && (present >> (k + 2) % 3 & 1))
            sum[3 + k] += share * all;
      }
   }
   return sum;
}

CellCoupling::CellCoupling(const Assembly &assembly, const std::vector<CoupledCell> &cells)
    : m_assembly(&assembly), m_number(static_cast<std::size_t>(assembly.cells), -1), m_damped(assembly.damped)
{
   for (const CoupledCell &cell : cells) {
      m_number[cell.cell] = static_cast<std::int64_t>(m_cell.size());
      m_cell.push_back(cell.cell);
   }
   listBonds();
   for (const CoupledCell &cell : cells)
      addCell(cell);
   const std::size_t bonds = m_bond.size();
   for (Column *column : {&m_room.stretch, &m_room.tension})
      column->resize(bonds);
   for (Column &column : m_room.gradient)
      column.resize(bonds);
   for (Column &column : m_room.stress)
      column.resize(m_cell.size());
   if (!m_damped)
      return;
   m_room.rate.resize(bonds);
   for (Column &column : m_room.loss)
      column.resize(m_cell.size());
}

void CellCoupling::listBonds()
{
   const Assembly &assembly = *m_assembly;
   for (std::int64_t i = 0; i < assembly.group[3]; ++i)
      if (m_number[assembly.a[i]] >= 0 || m_number[assembly.b[i]] >= 0)
         m_bond.push_back(i);
   for (auto &weight : m_weight)
      weight.resize(m_bond.size());
   m_first.assign(static_cast<std::size_t>(assembly.cells) + 1, 0);
   for (const std::int64_t bond : m_bond) {
      ++m_first[assembly.a[bond] + 1];
      ++m_first[assembly.b[bond] + 1];
   }
   for (std::int64_t i = 0; i < assembly.cells; ++i)
      m_first[i + 1] += m_first[i];
   m_slot.resize(2 * m_bond.size());
   std::vector<std::int64_t> next(m_first.begin(), m_first.end() - 1);
   for (std::int64_t n = 0; n < static_cast<std::int64_t>(m_bond.size()); ++n) {
      m_slot[next[assembly.a[m_bond[n]]]++] = 2 * n;
      m_slot[next[assembly.b[m_bond[n]]]++] = 2 * n + 1;
   }
}

/// A half's strain per stretch of the whole bond is what springs (dampers) in series give it, over the number
/// of bonds that the mean is taken of. The loss matrix has the ratio of damping to stiffness of the cell's
/// own half bonds, in each direction the smallest: with their losses none of a cell's motions then gains
/// energy.
void CellCoupling::addCell(const CoupledCell &cell)
{
   std::array<double, 3> bonds{}, ratio{};
   for (std::int64_t s = m_first[cell.cell]; s < m_first[cell.cell + 1]; ++s)
      ++bonds[axisOf(m_slot[s] / 2)];
   ratio.fill(std::numeric_limits<double>::infinity());
   for (std::int64_t s = m_first[cell.cell]; s < m_first[cell.cell + 1]; ++s) {
      const std::int64_t number = m_slot[s] / 2, bond = m_bond[number];
      const int axis = axisOf(number);
      const double length = m_assembly->lengthOf(bond), own = cell.youngsModulus * cell.area[axis] / length;
      const double a = m_assembly->mass[m_assembly->a[bond]], b = m_assembly->mass[m_assembly->b[bond]];
      const double loss = 2 * cell.dampingRatio * std::sqrt(own * a * b / (a + b));
      const double each = 1 / (bonds[axis] * length);
      const BondConstants &k = m_assembly->constants[bond];
      m_weight[m_slot[s] & 1][number] = {own > 0 ? each * k.k[0] / own : 0,
                                         loss > 0 ? each * k.d[0] / loss : 0};
      ratio[axis] = std::min(ratio[axis], own > 0 ? loss / own : 0);
   }
   std::array<double, 3> reach{}, scale{};
   for (int k = 0; k < 3; ++k) {
      reach[k] = bonds[k] / 2;
      scale[k] = bonds[k] > 0 ? std::sqrt(ratio[k]) : 0;
   }
   const Symmetric k = poissonStiffness(cell.youngsModulus, cell.poissonRatio, cell.volume, reach);
   m_stiffness.push_back(k);
   m_loss.push_back(m_damped ? scaled(k, scale) : Symmetric{});
}

BondEnds CellCoupling::endsAt(const State &state, std::int64_t number) const
{
   const std::int64_t bond = m_bond[number];
   return bondEnds<false>(*m_assembly, state, bond, m_assembly->frameOf(bond));
}

Vec3 CellCoupling::meanOf(std::int64_t coupled, const Column &stretch, double Weight::*weight) const
{
   double mean[3]{};
   const std::int64_t cell = m_cell[coupled];
   for (std::int64_t s = m_first[cell]; s < m_first[cell + 1]; ++s) {
      const std::int64_t number = m_slot[s] / 2;
      mean[axisOf(number)] += m_weight[m_slot[s] & 1][number].*weight * stretch[number];
   }
   return {mean[0], mean[1], mean[2]};
}

double CellCoupling::energy(const State &state, const RestShape *rest) const
{
   Column stretch(m_bond.size());
   for (std::int64_t n = 0; n < static_cast<std::int64_t>(m_bond.size()); ++n)
      stretch[n] = stretchOf(endsAt(state, n)).stretch - restOf(n, rest);
   double sum = 0;
   for (std::size_t i = 0; i < m_cell.size(); ++i) {
      const Vec3 e = meanOf(static_cast<std::int64_t>(i), stretch, &Weight::strain);
      const Symmetric &k = m_stiffness[i];
      sum += 0.5 * (k[0] * e.x * e.x + k[1] * e.y * e.y + k[2] * e.z * e.z) + k[3] * e.y * e.z +
             k[4] * e.z * e.x + k[5] * e.x * e.y;
   }
   return sum;
}

/// At rest a stretch depends on the displacements along its bond alone: row sums of each cell's matrix.
void CellCoupling::addSums(std::int64_t coupled, const Symmetric &matrix, double Weight::*weight,
                           CellForces &sums) const
{
   const std::int64_t cell = m_cell[coupled];
   double own[3]{}, all[3]{}, row[3]{}; // of the cell itself; magnitudes of all cells
   for (std::int64_t s = m_first[cell]; s < m_first[cell + 1]; ++s) {
      const int axis = axisOf(m_slot[s] / 2);
      const double w = m_weight[m_slot[s] & 1][m_slot[s] / 2].*weight;
      own[axis] += m_slot[s] & 1 ? w : -w;
      all[axis] += w;
   }
   for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
         row[k] += std::abs(at(matrix, k, j)) * (all[j] + std::abs(own[j]));
   for (int k = 0; k < 3; ++k)
      sums[k][cell] += std::abs(own[k]) * row[k];
   for (std::int64_t s = m_first[cell]; s < m_first[cell + 1]; ++s) {
      const int k = axisOf(m_slot[s] / 2);
      sums[k][cellAt(m_slot[s] ^ 1)] += m_weight[m_slot[s] & 1][m_slot[s] / 2].*weight * row[k];
   }
}

void CellCoupling::addRowSums(CellForces &stiffness, CellForces &damping) const
{
   for (std::size_t i = 0; i < m_cell.size(); ++i) {
      addSums(static_cast<std::int64_t>(i), m_stiffness[i], &Weight::strain, stiffness);
      addSums(static_cast<std::int64_t>(i), m_loss[i], &Weight::rate, damping);
   }
}

} // namespace bonds
