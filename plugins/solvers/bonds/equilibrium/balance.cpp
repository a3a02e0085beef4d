// Each bond once, then each cell adds up its own in bond order: nothing depends on the number of threads.
#include "equilibrium/balance.h"

#include "model/bond_ends.h"
#include "model/contact.h"
#include "solid/couplings.h"

#include <cmath>
#include <limits>
#include <string>

namespace bonds {

namespace {

Vec3 stretchOf(const Assembly &assembly, const RestShape &rest, std::int64_t bond)
{
   if (rest.d[0].empty())
      return {};
   return rest.separation(bond) - Vec3{assembly.lengthOf(bond), 0, 0};
}
Vec3 turnOf(const RestShape &rest, std::int64_t bond)
{
   return rest.phi[0].empty() ? Vec3{} : rest.turn(bond);
}

/// As couplings take it: none when nothing is driven.
const RestShape *restOf(const RestShape &rest) { return rest.d[0].empty() ? nullptr : &rest; }

BondPoint pointOf(const Assembly &assembly, const State &state, const RestShape &rest, std::int64_t bond,
                  const Mat3 &frame, bool rates)
{
   const BondConstants &k = assembly.constants[bond];
   const Vec3 stretch = stretchOf(assembly, rest, bond), turn = turnOf(rest, bond);
   return rates ? bondPoint<true>(bondEnds<true>(assembly, state, bond, frame), k, stretch, turn)
                : bondPoint<false>(bondEnds<false>(assembly, state, bond, frame), k, stretch, turn);
}

double dampedPower(const BondPoint &r, const BondConstants &k, const BondEnds &ends)
{
   Vec3 d, phi, spin;
   strainRates(r, k, transposed(r.middle, ends.dv), transposed(r.middle, ends.wa),
               transposed(r.middle, ends.wb), d, phi, spin);
   return dot(scaled(k.d, d), d) + dot(scaled(k.e, phi), phi);
}

void put(double *to, Vec3 v, double sign)
{
   to[0] += sign * v.x;
   to[1] += sign * v.y;
   to[2] += sign * v.z;
}

/// N that the last digits of a bond's displacements and turns are worth; several roundings meet in a cell.
double roundingOf(const Assembly &assembly, const State &state, std::int64_t bond)
{
   constexpr double kDigits = 16 * std::numeric_limits<double>::epsilon();
   const std::int64_t a = assembly.a[bond], b = assembly.b[bond];
   const BondConstants &k = assembly.constants[bond];
   const double length = assembly.lengthOf(bond),
                moved = squared(state.displacementOf(a)) + squared(state.displacementOf(b)),
                turned = squared(vec(state.turnOf(a))) + squared(vec(state.turnOf(b)));
   return kDigits * std::max({k.k[0], k.k[1], k.k[2]}) * std::sqrt(2 * (moved + turned * (length * length)));
}

/// Largest force that the actuated rest shape would call up if nothing could move.
double blockedForce(const BondConstants &k, Vec3 stretch, Vec3 turn, double length)
{
   const Vec3 f = scaled(k.k, stretch), c = scaled(k.c, turn);
   return std::max(norm(f), norm(c) / length);
}

} // namespace

Balance::Balance(const sdk::SceneView &scene, const Options &options)
    : m_assembly(scene, options), m_pitch(scene.pitch()), m_actuation(scene, m_assembly),
      m_supports(scene, m_assembly), m_couplings(makeCouplings(scene, m_assembly))
{
   m_index.resize(static_cast<std::size_t>(m_assembly.cells));
   for (std::int64_t i = 0; i < m_assembly.cells; ++i)
      std::copy_n(scene.index(i), 3, m_index[i].begin());
   if (m_assembly.links > 0) {
      m_pitch = 0;
      for (const double length : m_assembly.constants.lengths())
         m_pitch = std::max(m_pitch, length);
   }
   if (m_assembly.hasLoads)
      setLoads(scene.channel("force", 6));
}

std::string Balance::name(std::int64_t cell) const
{
   const auto &at = m_index[cell];
   return "(" + std::to_string(at[0]) + ", " + std::to_string(at[1]) + ", " + std::to_string(at[2]) + ")";
}

double Balance::bondLoad(std::int64_t bond, const State &state, const RestShape &rest, bool rates,
                         BondLoad &out, Measure &measure) const
{
   const Mat3 frame = m_assembly.frameOf(bond);
   const BondConstants &k = m_assembly.constants[bond];
   const BondPoint r = pointOf(m_assembly, state, rest, bond, frame, rates);
   const EndForces f = endForces(r);
   out = {transposed(frame, f.force), transposed(frame, f.torqueA), transposed(frame, f.torqueB)};
   const double torque = std::max(squared(f.torqueA), squared(f.torqueB)) / (m_pitch * m_pitch);
   measure.atWork = std::max(measure.atWork, std::sqrt(std::max(squared(f.force), torque)));
   measure.rounding = std::max(measure.rounding, roundingOf(m_assembly, state, bond));
   if (!rest.d[0].empty())
      measure.atWork = std::max(measure.atWork, blockedForce(k, stretchOf(m_assembly, rest, bond),
                                                             turnOf(rest, bond), m_assembly.lengthOf(bond)));
   return rates ? dampedPower(r, k, bondEnds<true>(m_assembly, state, bond, frame)) : 0;
}

double Balance::internal(const sdk::Call &call, const State &state, const Loading &loading, bool rates,
                         Vector &out, Measure &measure) const
{
   const auto pieces = static_cast<std::size_t>(piecesOf(m_assembly.links));
   Column power(pieces, 0);
   std::vector<Measure> largest(pieces);
   m_bondLoads.resize(static_cast<std::size_t>(m_assembly.links));
   forPieces(call, m_assembly.links, [&](std::int64_t begin, std::int64_t end, std::int64_t piece) {
      for (std::int64_t i = begin; i < end; ++i)
         power[piece] += bondLoad(i, state, loading.rest, rates, m_bondLoads[i], largest[piece]);
   });
   out.setZero(6 * m_assembly.cells);
   forPieces(call, m_assembly.cells, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
      for (std::int64_t e = m_assembly.first[begin], cell = begin; cell < end; ++cell)
         for (double *to = out.data() + 6 * cell; e < m_assembly.first[cell + 1]; ++e) {
            const BondLoad &load = m_bondLoads[m_assembly.bondsOf[e] / 2];
            const bool atB = (m_assembly.bondsOf[e] & 1) != 0;
            put(to, load.force, atB ? -1 : 1);
            put(to + 3, atB ? load.torqueB : load.torqueA, 1);
         }
   });
   double total = 0;
   for (std::size_t i = 0; i < pieces; ++i) {
      total += power[i];
      measure.atWork = std::max(measure.atWork, largest[i].atWork);
      measure.rounding = std::max(measure.rounding, largest[i].rounding);
   }
   if (m_couplings.empty())
      return total;
   CellForces forces;
   for (Column &column : forces)
      column.assign(static_cast<std::size_t>(m_assembly.cells), 0);
   for (const auto &coupling : m_couplings)
      total += coupling->addForces(call, state, restOf(loading.rest), forces);
   for (std::int64_t i = 0; i < m_assembly.cells; ++i)
      for (int k = 0; k < 6; ++k) {
         out[6 * i + k] += forces[k][i];
         measure.atWork = std::max(measure.atWork, std::abs(forces[k][i]) / (k < 3 ? 1 : m_pitch));
      }
   return total;
}

void Balance::external(const State &state, const Loading &loading, Vector &out, Measure &measure) const
{
   const bool loads = !loading.force.empty();
   out.setZero(6 * m_assembly.cells);
   for (std::int64_t i = 0; i < m_assembly.cells; ++i) {
      double *f = out.data() + 6 * i;
      if (loads)
         std::copy_n(loading.force.begin() + 6 * i, 6, f);
      put(f, loading.gravity, m_assembly.mass[i]);
      const double most =
          std::max(squared({f[0], f[1], f[2]}), squared({f[3], f[4], f[5]}) / (m_pitch * m_pitch));
      measure.atWork = std::max(measure.atWork, std::sqrt(most));
      if (m_assembly.hasGround) // after the loads are weighed: what stands at rest has a sum of nothing
         f[2] += m_assembly.ground.stiffness * std::max(0.0, penetration(m_assembly, state, i));
   }
}

void Balance::weigh(const Vector &residual, Measure &measure) const
{
   measure.unbalanced = 0;
   const Vector &free = m_supports.free();
   for (std::int64_t i = 0; i < m_assembly.cells; ++i)
      for (int k = 0; k < 6; ++k) {
         const double size = std::abs(residual[6 * i + k] * free[6 * i + k]) / (k < 3 ? 1 : m_pitch);
         if (!(size <= measure.unbalanced)) { // no number counts as the worst
            measure.unbalanced = size;
            measure.cell = i;
         }
      }
}

bool Balance::stands(const State &state, std::int64_t cell) const
{
   constexpr double kTouching = 1e-9; // of the pitch
   return m_assembly.hasGround && penetration(m_assembly, state, cell) >= -kTouching * m_pitch;
}

BlockMatrix Balance::pattern() const
{
   std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
   for (std::int64_t i = 0; i < m_assembly.links; ++i)
      pairs.emplace_back(m_assembly.a[i], m_assembly.b[i]);
   const State rest(m_assembly.cells);
   for (const auto &coupling : m_couplings)
      coupling->addStiffness(rest, nullptr, [&](std::int64_t row, std::int64_t column, const double *) {
         if (row < column)
            pairs.emplace_back(static_cast<std::int32_t>(row), static_cast<std::int32_t>(column));
      });
   return {m_assembly.cells, pairs};
}

void Balance::cellStiffness(std::int64_t cell, const State &state, const RestShape &rest,
                            double dampingOverTime, BlockMatrix &out) const
{
   auto own = out[out.diagonal(cell)];
   for (std::int64_t e = m_assembly.first[cell]; e < bondsEnd(cell); ++e) {
      const std::int64_t bond = m_assembly.bondsOf[e] / 2;
      const bool atB = (m_assembly.bondsOf[e] & 1) != 0;
      const Mat3 frame = m_assembly.frameOf(bond);
      const BondPoint r = pointOf(m_assembly, state, rest, bond, frame, false);
      BondConstants k = m_assembly.constants[bond];
      for (int j = 0; j < 3; ++j) {
         k.k[j] += dampingOverTime * k.d[j];
         k.c[j] += dampingOverTime * k.e[j];
      }
      auto other = out[out.find(cell, atB ? m_assembly.a[bond] : m_assembly.b[bond])];
      constexpr Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      for (int j = 0; j < 3; ++j) {
         const Vec3 along = transposed(r.middle, frame * unit[j]);
         const EndForces change[3] = {forceChange(r, k, along, {}, {}), forceChange(r, k, {}, along, {}),
                                      forceChange(r, k, {}, {}, along)};
         const auto column = [&](const EndForces &f, double sign, double *to) {
            put(to, transposed(frame, r.middle * f.force), atB ? sign : -sign);
            put(to + 3, transposed(frame, r.middle * (atB ? f.torqueB : f.torqueA)), -sign);
         };
         column(change[0], atB ? 1 : -1, own.col(j).data());
         column(change[0], atB ? -1 : 1, other.col(j).data());
         column(change[1], 1, (atB ? other : own).col(3 + j).data());
         column(change[2], 1, (atB ? own : other).col(3 + j).data());
      }
   }
   if (stands(state, cell))
      own(2, 2) += m_assembly.ground.stiffness;
}

void Balance::stiffness(const sdk::Call &call, const State &state, const Loading &loading,
                        double dampingOverTime, BlockMatrix &out) const
{
   forPieces(call, m_assembly.cells, [&](std::int64_t begin, std::int64_t end, std::int64_t) {
      for (std::int64_t i = begin; i < end; ++i) {
         out.clearRow(i);
         cellStiffness(i, state, loading.rest, dampingOverTime, out);
      }
   });
   double factor = 1;
   const AddBlock add = [&](std::int64_t row, std::int64_t column, const double *block) {
      out[out.find(row, column)] +=
          factor * Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(block);
   };
   for (const auto &coupling : m_couplings)
      coupling->addStiffness(state, restOf(loading.rest), add);
   factor = dampingOverTime;
   for (const auto &coupling : m_couplings)
      if (dampingOverTime > 0)
         coupling->addDamping(state, add);
}

double Balance::elasticEnergy(const State &state, const RestShape &rest) const
{
   double sum = 0;
   for (std::int64_t i = 0; i < m_assembly.links; ++i) {
      const BondConstants &k = m_assembly.constants[i];
      const BondPoint r = bondGeometry(bondEnds<false>(m_assembly, state, i, m_assembly.frameOf(i)));
      const Vec3 phi = r.phi - turnOf(rest, i);
      const Vec3 d = ownStrain(r, k, phi, r.stretch - stretchOf(m_assembly, rest, i));
      sum += 0.5 * (dot(scaled(k.k, d), d) + dot(scaled(k.c, phi), phi));
   }
   for (const auto &coupling : m_couplings)
      sum += coupling->energy(state, restOf(rest));
   return sum;
}

double Balance::contactEnergy(const State &state) const
{
   double sum = 0;
   for (std::int64_t i = 0; m_assembly.hasGround && i < m_assembly.cells; ++i) {
      const double depth = std::max(0.0, penetration(m_assembly, state, i));
      sum += 0.5 * m_assembly.ground.stiffness * depth * depth;
   }
   return sum;
}

double Balance::gravityEnergy(const State &state) const
{
   double sum = 0;
   const Vec3 g{m_assembly.gravity[0], m_assembly.gravity[1], m_assembly.gravity[2]};
   for (std::int64_t i = 0; m_assembly.hasGravity && i < m_assembly.cells; ++i)
      sum -= m_assembly.mass[i] * dot(g, state.displacementOf(i));
   return sum;
}

void advance(const State &from, const Vector &change, double factor, State &to)
{
   for (std::int64_t i = 0; i < from.n; ++i) {
      const double *d = change.data() + 6 * i;
      for (int k = 0; k < 3; ++k)
         to.column(k)[i] = from.column(k)[i] + factor * d[k];
      to.setTurnedOn(i, from.turnOf(i), factor * Vec3{d[3], d[4], d[5]});
   }
}

} // namespace bonds
