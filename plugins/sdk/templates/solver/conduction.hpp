// Steady heat conduction from cell to cell: temperatures at which what flows into each cell flows out of it
// again.
//
//    sum over links of G (T_other - T) + power = 0 for each cell whose temperature is not set
//
// G, in W/K, is that of the two half cells in series: 1 / (d/2 / (k A) + d/2 / (k' A')), with the material
// property "thermal_conductivity" k in W/(m K), the distance d of the centres, and the cross-section A of a
// cell's box across the link. A is exact for boxes linked along their axes and a fair guess for other shapes.
// Fields of the design: "temperature", K, sets a cell's temperature (the last one given counts); "heat", W,
// is released in a cell (all add up).
//
// The equations are symmetric and positive: conjugate gradients, each unknown scaled by its diagonal
// (Shewchuk, An Introduction to the Conjugate Gradient Method, 1994, B3). Sums run over fixed pieces, in
// order, so that the number of threads does not show.
#pragma once

#include <diatom/solver.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace conduction {

using namespace diatom::sdk;

class Conduction
{
public:
   static const diatom_capabilities &capabilities()
   {
      static const char *const physics[] = {"heat"};
      static const char *const analyses[] = {"statics"};
      static const char *const effects[] = {"temperature", "heat"};
      static const char *const lattices[] = {"*"};
      static const diatom_capabilities caps{sizeof caps, 1, 1, physics, analyses, 2, effects, 1, lattices, 1};
      return caps;
   }

   static void estimate(Call, Values, const SceneView &scene, diatom_estimate &estimate)
   {
      estimate.bytes = 80.0 * static_cast<double>(scene.cells()) + 48.0 * static_cast<double>(scene.links());
      estimate.step_seconds = 2e-8 * static_cast<double>(scene.cells() + scene.links()); // of an iteration
      estimate.stable_link = -1;
   }

   Conduction(Call, Values, const SceneView &scene)
       : m_cells(scene.cells()), m_set(size(m_cells)), m_temperature(size(m_cells)), m_power(size(m_cells)),
         m_residual(size(m_cells)), m_scaled(size(m_cells)), m_direction(size(m_cells)),
         m_product(size(m_cells))
   {
      findConductances(scene);
      takeFields(scene.channel("temperature", 1), scene.channel("heat", 1));
      refuseLooseBodies(scene);
      m_output[0] = {"temperature", "K", m_cells, 1};
      m_output[1] = {"supplied", "W", m_cells, 1}; // by what holds the temperature of a cell
      m_output[2] = {"link_heat", "W", scene.links(), 1};
   }

   /// Other temperatures and powers, of the same cells or others; the answer so far is where the search
   /// begins.
   void apply(Call, std::span<const diatom_channel> channels)
   {
      const Channel temperature = findChannel(channels, "temperature", 1, m_cells);
      const std::vector<char> before = m_set;
      takeFields(temperature, findChannel(channels, "heat", 1, m_cells));
      if (m_set != before)
         throw Failure(DIATOM_UNSUPPORTED, "other cells than before have a set temperature");
   }

   std::int32_t step(Call call, const diatom_step_request &request, diatom_step_result &result)
   {
      result.bad_cell = result.bad_link = -1;
      result.time = request.until;
      result.steps = result.iterations = 0;
      if (!m_running)
         begin(call);
      const double wanted = request.tolerance > 0 ? request.tolerance : 1e-8,
                   start = std::max(m_left, wanted);
      while (m_left > wanted && result.iterations < request.max_steps) {
         if (call.cancelled())
            return DIATOM_CANCELLED;
         iterate(call);
         ++result.iterations;
         if (!std::isfinite(m_left) || m_iterations > 20 * m_cells + 1000) {
            result.residual = m_left;
            result.bad_cell = worstCell();
            result.state = DIATOM_DIVERGED;
            return DIATOM_OK;
         }
         if (start > wanted && m_left > 0)
            call.progress(std::clamp(std::log(start / m_left) / std::log(start / wanted), 0.0, 1.0),
                          "temperatures");
      }
      result.steps = result.iterations;
      result.residual = m_left;
      result.state = m_left > wanted ? DIATOM_RUNNING : DIATOM_CONVERGED;
      if (result.state == DIATOM_CONVERGED)
         m_running = false;
      return DIATOM_OK;
   }

   const diatom_outputs &outputs() const { return m_outputs; }

   void read(Call, std::int64_t output, std::int64_t first, std::int64_t count, double *values) const
   {
      for (std::int64_t i = first; i < first + count; ++i)
         *values++ = output == 0 ? m_temperature[size(i)] : output == 1 ? supplied(size(i)) : flow(size(i));
   }

private:
   static constexpr std::int64_t kGrain = 4096;
   static std::size_t size(std::int64_t n) { return static_cast<std::size_t>(n); }

   struct Link
   {
      std::size_t a, b;
      double conductance;
   };
   /// A link as one of its cells sees it.
   struct Neighbour
   {
      std::size_t cell;
      double conductance;
   };

   /// Thermal resistance of the half of a cell towards another, K/W.
   static double halfResistance(const SceneView &scene, std::int64_t cell, const double *towards,
                                double distance)
   {
      const std::int32_t material = scene.material(cell);
      const double k = scene.property(material, "thermal_conductivity");
      if (!(k > 0) || !std::isfinite(k))
         throw Failure(
             DIATOM_BAD_INPUT,
             "the material of cell " + scene.name(cell) +
                 " has no thermal_conductivity above 0; set it among the material's properties, in W/(m K)");
      // The box's width along the link, in its own axes: rotate the direction back by the unit quaternion.
      const double *q = scene.orientation(cell), *e = scene.extent(cell);
      const double w = q[0], x = -q[1], y = -q[2], z = -q[3];
      const double tx = 2 * (y * towards[2] - z * towards[1]), ty = 2 * (z * towards[0] - x * towards[2]),
                   tz = 2 * (x * towards[1] - y * towards[0]);
      const double u[3] = {towards[0] + w * tx + y * tz - z * ty, towards[1] + w * ty + z * tx - x * tz,
                           towards[2] + w * tz + x * ty - y * tx};
      const double width = std::abs(u[0]) * e[0] + std::abs(u[1]) * e[1] + std::abs(u[2]) * e[2];
      return distance / 2 / (k * e[0] * e[1] * e[2] / width);
   }

   void findConductances(const SceneView &scene)
   {
      std::vector<std::size_t> count(size(m_cells) + 1, 0);
      for (std::int64_t n = 0; n < scene.links(); ++n) {
         const std::int32_t a = scene.linkA(n), b = scene.linkB(n);
         double step[3], square = 0;
         for (int axis = 0; axis < 3; ++axis) {
            step[axis] = scene.position(b)[axis] - scene.position(a)[axis];
            square += step[axis] * step[axis];
         }
         const double distance = std::sqrt(square);
         if (!(distance > 0))
            throw Failure(DIATOM_BAD_INPUT,
                          "cells " + scene.name(a) + " and " + scene.name(b) + " lie at one place");
         for (double &component : step)
            component /= distance;
         const double resistance =
             halfResistance(scene, a, step, distance) + halfResistance(scene, b, step, distance);
         m_links.push_back({size(a), size(b), 1 / resistance});
         ++count[size(a) + 1];
         ++count[size(b) + 1];
      }
      std::partial_sum(count.begin(), count.end(), count.begin());
      m_start = count;
      m_neighbour.resize(2 * m_links.size());
      m_diagonal.assign(size(m_cells), 0);
      for (const Link &link : m_links)
         for (const auto &[here, there] : {std::pair(link.a, link.b), std::pair(link.b, link.a)}) {
            m_neighbour[count[here]++] = {there, link.conductance};
            m_diagonal[here] += link.conductance;
         }
   }

   void takeFields(const Channel &temperature, const Channel &heat)
   {
      std::fill(m_set.begin(), m_set.end(), char{0});
      std::fill(m_power.begin(), m_power.end(), 0.0);
      for (std::int64_t i = 0; i < temperature.count(); ++i) {
         if (temperature.row(i)[0] < 0)
            throw Failure(DIATOM_BAD_INPUT,
                          "a temperature is below absolute zero; temperatures are in kelvin");
         m_set[size(temperature.where(i))] = 1;
         m_temperature[size(temperature.where(i))] = temperature.row(i)[0];
      }
      for (std::int64_t i = 0; i < heat.count(); ++i)
         m_power[size(heat.where(i))] += heat.row(i)[0];
      m_running = false;
   }

   /// A body of linked cells without any set temperature could have any.
   void refuseLooseBodies(const SceneView &scene) const
   {
      std::vector<std::size_t> reached;
      std::vector<char> known = m_set;
      for (std::size_t cell = 0; cell < known.size(); ++cell)
         if (known[cell] != 0)
            reached.push_back(cell);
      while (!reached.empty()) {
         const std::size_t cell = reached.back();
         reached.pop_back();
         for (std::size_t n = m_start[cell]; n < m_start[cell + 1]; ++n)
            if (known[m_neighbour[n].cell] == 0) {
               known[m_neighbour[n].cell] = 1;
               reached.push_back(m_neighbour[n].cell);
            }
      }
      const auto loose = std::find(known.begin(), known.end(), char{0});
      if (loose != known.end())
         throw Failure(DIATOM_BAD_INPUT, "nothing sets a temperature of the body that cell " +
                                             scene.name(loose - known.begin()) +
                                             " belongs to; set one with the field \"temperature\", in K");
   }

   /// Net heat into a cell from its neighbours, for a field of temperatures.
   double inflow(std::size_t cell, const std::vector<double> &field) const
   {
      double sum = 0;
      for (std::size_t n = m_start[cell]; n < m_start[cell + 1]; ++n)
         sum += m_neighbour[n].conductance * (field[m_neighbour[n].cell] - field[cell]);
      return sum;
   }

   double flow(std::size_t link) const
   {
      const Link &l = m_links[link];
      return l.conductance * (m_temperature[l.a] - m_temperature[l.b]);
   }

   double supplied(std::size_t cell) const
   {
      return m_set[cell] != 0 ? -inflow(cell, m_temperature) - m_power[cell] : 0;
   }

   template<typename Body>
   void eachCell(Call call, const Body &of) const
   {
      auto body = [&](std::int64_t first, std::int64_t end) {
         for (std::int64_t cell = first; cell < end; ++cell)
            of(size(cell));
      };
      call.parallelFor(m_cells, kGrain, body);
   }

   /// Sum over the cells in fixed pieces.
   double dot(Call call, const std::vector<double> &u, const std::vector<double> &v)
   {
      m_sums.assign(size((m_cells + kGrain - 1) / kGrain), 0);
      auto body = [&](std::int64_t first, std::int64_t end) {
         double sum = 0;
         for (std::int64_t cell = first; cell < end; ++cell)
            sum += u[size(cell)] * v[size(cell)];
         m_sums[size(first / kGrain)] = sum;
      };
      call.parallelFor(m_cells, kGrain, body);
      return std::accumulate(m_sums.begin(), m_sums.end(), 0.0);
   }

   /// Cells that are not set begin at the mean of those that are.
   void begin(Call call)
   {
      double mean = 0;
      std::int64_t set = 0;
      for (std::size_t cell = 0; cell < m_set.size(); ++cell)
         if (m_set[cell] != 0)
            mean += (m_temperature[cell] - mean) / static_cast<double>(++set);
      if (!m_begun)
         for (std::size_t cell = 0; cell < m_set.size(); ++cell)
            m_temperature[cell] = m_set[cell] != 0 ? m_temperature[cell] : mean;
      m_begun = m_running = true;
      m_iterations = 0;
      eachCell(call, [&](std::size_t cell) {
         m_residual[cell] = m_set[cell] != 0 ? 0 : inflow(cell, m_temperature) + m_power[cell];
         m_scaled[cell] = m_set[cell] != 0 ? 0 : m_residual[cell] / m_diagonal[cell];
         m_direction[cell] = m_scaled[cell];
      });
      m_square = dot(call, m_residual, m_scaled);
      measure();
   }

   void iterate(Call call)
   {
      eachCell(call, [&](std::size_t cell) {
         m_product[cell] = m_set[cell] != 0 ? 0 : -inflow(cell, m_direction);
      });
      const double length = m_square / dot(call, m_direction, m_product);
      eachCell(call, [&](std::size_t cell) {
         m_temperature[cell] += length * m_direction[cell];
         m_residual[cell] -= length * m_product[cell];
         m_scaled[cell] = m_set[cell] != 0 ? 0 : m_residual[cell] / m_diagonal[cell];
      });
      const double square = dot(call, m_residual, m_scaled);
      eachCell(call, [&](std::size_t cell) {
         m_direction[cell] = m_scaled[cell] + square / m_square * m_direction[cell];
      });
      m_square = square;
      ++m_iterations;
      measure();
   }

   /// Largest heat that a cell keeps over the largest that flows anywhere.
   void measure()
   {
      double kept = 0, largest = 0;
      for (const double r : m_residual)
         kept = std::isfinite(r) ? std::max(kept, std::abs(r)) : r;
      for (std::size_t link = 0; link < m_links.size(); ++link)
         largest = std::max(largest, std::abs(flow(link)));
      for (const double power : m_power)
         largest = std::max(largest, std::abs(power));
      m_left = kept == 0 ? 0 : kept / largest;
   }

   std::int64_t worstCell() const
   {
      const auto worse = [](double a, double b) { return std::abs(a) < std::abs(b); };
      return std::max_element(m_residual.begin(), m_residual.end(), worse) - m_residual.begin();
   }

   std::int64_t m_cells;
   std::vector<Link> m_links;
   std::vector<std::size_t> m_start; // neighbours of cell i: m_start[i] to m_start[i + 1]
   std::vector<Neighbour> m_neighbour;
   std::vector<char> m_set; // 1 where the temperature is set
   std::vector<double> m_diagonal, m_temperature, m_power, m_residual, m_scaled, m_direction, m_product,
       m_sums;
   double m_square = 0, m_left = 0;
   std::int64_t m_iterations = 0;
   bool m_begun = false, m_running = false;
   diatom_output m_output[3] = {};
   diatom_outputs m_outputs{sizeof m_outputs, 3, m_output};
};

} // namespace conduction
