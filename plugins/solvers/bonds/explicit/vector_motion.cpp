#include "explicit/vector_motion.h"

#include "explicit/box_columns.h"
#include "explicit/forces.h"
#include "explicit/stages.h"

namespace bonds {

std::optional<std::string> whyNotVector(const Assembly &assembly, const Couplings &couplings,
                                        const Options &options)
{
   if (!couplings.empty())
      return "solid elements and Poisson's coupling";
   if (assembly.law == Law::simple)
      return "the simple gradient";
   if (options.instructions == Options::Instructions::scalar)
      return "the instructions asked for";
   return {};
}

namespace {

/// A distance between columns that does not put all of them into the same places of the cache.
template<typename T>
std::size_t strideFor(std::size_t places)
{
   const std::size_t line = 64 / sizeof(T), page = 4096 / sizeof(T);
   std::size_t stride = (places + 3 * kBlock + line - 1) / line * line;
   if (stride * 4 > page)
      stride = (stride + page - 1) / page * page + 5 * line;
   return stride;
}

template<typename T>
PageVector<T> converted(const std::vector<double> &from)
{
   PageVector<T> out;
   out.reserve(from.size());
   for (const double value : from)
      out.push_back(static_cast<T>(value));
   return out;
}

/// Cells that are held in every degree of freedom and follow no curve.
std::vector<bool> stillCells(const Assembly &assembly, const Drive &drive)
{
   std::vector<bool> still(static_cast<std::size_t>(assembly.cells));
   for (std::int64_t i = 0; i < assembly.cells; ++i)
      still[i] = assembly.fixed[i] == 63;
   for (const Drive::Led &led : drive.cells())
      still[led.cell] = false;
   return still;
}

} // namespace

template<typename T>
VectorMotion<T>::VectorMotion(const sdk::SceneView &scene, const Assembly &assembly,
                              const Couplings &couplings, const Options &options)
    : Motion(scene, assembly, couplings, options),
      m_layout(assembly, m_actuation.driven(assembly.links), stillCells(assembly, m_drive), 64 / sizeof(T)),
      m_kernel(sweepKernel<T>(
          {assembly.damped, assembly.law == Law::small, !options.reproducible, options.instructions}))
{
   m_sweep.stride = strideFor<T>(m_layout.places);
   takeCells();
   if (assembly.boxes)
      takeBoxes();
   takeBonds();
   makeRooms();
   m_sweep.drag = static_cast<T>(assembly.hasDrag ? assembly.drag : 0);
   gravityChanged();
   if (assembly.hasLoads)
      setLoads(scene.channel("force", 6));
   if (assembly.hasGround) {
      m_touching.assign(m_sweep.stride, T(-1e30));
      m_gripping.assign(m_sweep.stride, 0);
      for (std::int64_t i = 0; i < assembly.cells; ++i)
         m_touching[m_layout.place[i]] =
             static_cast<T>(assembly.ground.height - assembly.rest[2][i] + assembly.halfHeight[i]);
   }
   for (const Drive::Led &led : m_drive.cells())
      m_drivenPlaces.push_back({m_layout.place[led.cell], led, {}});
   std::sort(m_drivenPlaces.begin(), m_drivenPlaces.end(),
             [](const DrivenPlace &a, const DrivenPlace &b) { return a.place < b.place; });
   VectorMotion::save(0);
}

/// State, masses and supports in columns by place. Padding is held, and as heavy as nothing that matters.
template<typename T>
void VectorMotion<T>::takeCells()
{
   const Assembly &assembly = *m_assembly;
   const std::size_t stride = m_sweep.stride;
   m_columns.assign(13 * stride, 0);
   std::fill_n(column(3), stride, T(1));
   m_inverseMass.assign(stride, 1);
   m_inverseInertia.assign(stride, 1);
   m_heldPlaces.assign(stride, 63);
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      const std::size_t at = m_layout.place[i];
      m_inverseMass[at] = static_cast<T>(1 / assembly.mass[i]);
      m_inverseInertia[at] = static_cast<T>(1 / assembly.inertia[i]);
      m_heldPlaces[at] = assembly.fixed[i];
      push(i);
   }
   m_sweep.state = m_columns.data();
   m_sweep.inverseMass = m_inverseMass.data();
   m_sweep.inverseInertia = m_inverseInertia.data();
   m_sweep.held = m_heldPlaces.data();
}

template<typename T>
void VectorMotion<T>::takeBoxes()
{
   const Assembly &assembly = *m_assembly;
   std::vector<std::array<double, kBoxColumns>> all(static_cast<std::size_t>(assembly.cells));
   for (std::int64_t i = 0; i < assembly.cells; ++i) {
      all[i] = boxColumns(assembly, i);
      m_sweep.twoAxes = m_sweep.twoAxes || all[i][kSecondAxis + 3] != 0;
   }
   const std::size_t columns = m_sweep.twoAxes ? kBoxColumns : kSecondAxis;
   m_boxes.assign(columns * m_sweep.stride, 0);
   for (std::int64_t i = 0; i < assembly.cells; ++i)
      for (std::size_t k = 0; k < columns; ++k)
         m_boxes[k * m_sweep.stride + m_layout.place[i]] = static_cast<T>(all[i][k]);
   m_sweep.boxes = m_boxes.data();
}

template<typename T>
void VectorMotion<T>::takeBonds()
{
   m_pool = converted<T>(m_layout.pool);
   m_frames = converted<T>(m_layout.frames);
   m_layout.pool = {};
   m_restShape.assign(m_layout.restPlaces, 0);
   for (const Layout::RestPlace &rest : m_layout.rests)
      for (const std::int64_t cell : {m_assembly->a[rest.bond], m_assembly->b[rest.bond]})
         m_actuatedCells.push_back(cell);
   std::sort(m_actuatedCells.begin(), m_actuatedCells.end());
   m_actuatedCells.erase(std::unique(m_actuatedCells.begin(), m_actuatedCells.end()), m_actuatedCells.end());
   m_sweep.runs = m_layout.runs.data();
   m_sweep.chunks = m_layout.chunks.data();
   m_sweep.crossings = m_layout.crossings.data();
   m_sweep.listLo = m_layout.listLo.data();
   m_sweep.listHi = m_layout.listHi.data();
   m_sweep.pool = m_pool.data();
   m_sweep.rest = m_restShape.data();
   m_sweep.frames = m_frames.data();
   m_sweep.firstCross = m_layout.firstCross;
   m_sweep.span = m_layout.span;
}

/// What a step needs besides: what integrators remember, forces under way, sums of each tile.
template<typename T>
void VectorMotion<T>::makeRooms()
{
   const Assembly &assembly = *m_assembly;
   const std::size_t stride = m_sweep.stride;
   const bool rates = assembly.damped || assembly.hasDrag || assembly.hasGround;
   if (m_integrator == Options::Integrator::verlet && rates)
      m_rates.assign(6 * stride, 0);
   m_sweep.rate = m_rates.empty() ? column(7) : m_rates.data();
   if (!stagesOf(m_integrator).empty()) {
      m_start.assign(13 * stride, 0);
      m_sum.assign(13 * stride, 0);
      m_sweep.start = m_start.data();
      m_sweep.sum = m_sum.data();
   }
   m_sweep.slotStride = (m_layout.runs.size() - m_layout.firstCross) * kBlock;
   m_slots.assign(12 * m_sweep.slotStride, 0);
   m_sweep.slots = m_slots.data();
   std::size_t room = 0;
   for (const Tile &tile : m_layout.tiles) {
      m_roomAt.push_back(room);
      room += 6 * Window(tile, m_layout.span).stride;
   }
   m_rooms.resize(room);
   m_visits.resize(m_layout.tiles.size());
   m_sweepSums.resize(m_layout.tiles.size());
}

template<typename T>
std::string VectorMotion<T>::how() const
{
   return std::string(m_kernel.instructions) + (sizeof(T) == 4 ? ", f32" : ", f64");
}

template<typename T>
void VectorMotion<T>::pull(std::int64_t cell) const
{
   const std::size_t at = m_layout.place[cell];
   for (int k = 0; k < 13; ++k)
      m_state.column(k)[cell] = static_cast<double>(column(k)[at]);
}

template<typename T>
void VectorMotion<T>::push(std::int64_t cell)
{
   const std::size_t at = m_layout.place[cell];
   for (int k = 0; k < 13; ++k)
      column(k)[at] = static_cast<T>(m_state.column(k)[cell]);
}

template<typename T>
void VectorMotion<T>::readState() const
{
   if (!m_stale)
      return;
   m_stale = false;
   for (int k = 0; k < 13; ++k) {
      const T *from = column(k);
      double *to = m_state.column(k);
      for (std::int64_t i = 0; i < m_assembly->cells; ++i)
         to[i] = static_cast<double>(from[m_layout.place[i]]);
   }
}

template<typename T>
void VectorMotion<T>::readActuated() const
{
   for (const std::int64_t cell : m_actuatedCells)
      for (int k = 0; k < 7; ++k) // places and turns
         m_state.column(k)[cell] = static_cast<double>(column(k)[m_layout.place[cell]]);
}

template<typename T>
void VectorMotion<T>::restChanged()
{
   for (const Layout::RestPlace &place : m_layout.rests) {
      const Vec3 d = m_rest.separation(place.bond), phi = m_rest.turn(place.bond);
      const double stretch = d.x - m_assembly->lengthOf(place.bond), sign = place.reversed ? -1 : 1;
      const double all[6] = {stretch, d.y, sign * d.z, phi.x, phi.y, sign * phi.z};
      for (std::size_t k = 0; k < 6; ++k)
         m_restShape[place.at + k * kBlock] = static_cast<T>(all[k]);
   }
}

template<typename T>
void VectorMotion<T>::gravityChanged()
{
   for (int k = 0; k < 3; ++k)
      m_sweep.gravity[k] = static_cast<T>(m_assembly->hasGravity ? m_assembly->gravity[k] : 0);
}

template<typename T>
void VectorMotion<T>::setLoads(const sdk::Channel &loads)
{
   Motion::setLoads(loads);
   m_loadColumns.assign(6 * m_sweep.stride, 0);
   for (std::int64_t i = 0; i < m_assembly->cells; ++i)
      for (std::size_t k = 0; k < 6; ++k)
         m_loadColumns[k * m_sweep.stride + m_layout.place[i]] =
             static_cast<T>(m_loads[6 * static_cast<std::size_t>(i) + k]);
   m_sweep.loads = m_loadColumns.data();
}

template<typename T>
Motion::Moving VectorMotion<T>::moving() const
{
   Moving out;
   const bool falls = m_assembly->hasGravity;
   for (std::size_t i = 0; i < m_layout.places; ++i) {
      double move = 0, turn = 0, fall = 0;
      for (int k = 0; k < 3; ++k) {
         const auto v = static_cast<double>(column(7 + k)[i]), w = static_cast<double>(column(10 + k)[i]);
         move += v * v;
         turn += w * w;
         if (falls)
            fall -= static_cast<double>(m_sweep.gravity[k] * column(k)[i]);
      }
      const auto im = static_cast<double>(m_inverseMass[i]), ii = static_cast<double>(m_inverseInertia[i]);
      out.kinetic += 0.5 * (move / im + turn / ii);
      out.gravity += fall / im;
   }
   return out;
}

template<typename T>
void VectorMotion<T>::save(double time)
{
   Motion::save(time);
   m_savedColumns = m_columns;
   if (m_assembly->hasFriction)
      m_saved.grip = m_state.grip;
}

template<typename T>
double VectorMotion<T>::restore()
{
   m_columns = m_savedColumns;
   if (m_assembly->hasFriction) {
      m_state.grip = m_saved.grip;
      for (std::int64_t i = 0; i < m_assembly->cells; ++i)
         m_gripping[m_layout.place[i]] = grips(i);
   }
   m_stale = true;
   return Motion::restore();
}

template<typename T>
void VectorMotion<T>::sweep(const sdk::Call &call, const Move &move, double weight, double ahead)
{
   const auto tiles = static_cast<std::int64_t>(m_layout.tiles.size());
   const auto each = [&](const auto &body) {
      auto run = [&](std::int64_t begin, std::int64_t end) {
         const FlushDenormals mode;
         for (std::int64_t i = begin; i < end; ++i)
            body(static_cast<std::size_t>(i));
      };
      if (tiles > 1)
         call.parallelFor(tiles, 1, run);
      else
         run(0, tiles);
   };
   for (SweepSums &sums : m_sweepSums)
      sums = {};
   if (m_sweep.slotStride > 0)
      each([&](std::size_t i) { m_kernel.cross(m_sweep, m_layout.tiles[i], m_sweepSums[i]); });
   const bool visits = m_assembly->hasGround || !m_drivenPlaces.empty();
   each([&](std::size_t i) {
      SweepWork<T> work = m_sweep;
      if (visits) {
         m_visits[i] = {this, move, weight, ahead, {}};
         work.context = &m_visits[i];
         work.beforeKick = [](void *context, std::uint32_t begin, std::uint32_t end, T *lo, const T *hi,
                              std::size_t hiStride) {
            auto *visit = static_cast<Visit *>(context);
            visit->motion->visitBefore(*visit, begin, end, lo, hi, hiStride);
         };
         if (m_assembly->hasFriction)
            work.afterKick = [](void *context, std::uint32_t begin, std::uint32_t end) {
               auto *visit = static_cast<Visit *>(context);
               visit->motion->gripMoves(visit->sums, begin, end, visit->move.drift);
            };
      }
      m_kernel.tile(work, m_layout.tiles[i], move, m_rooms.data() + m_roomAt[i], m_sweepSums[i]);
   });
   for (std::size_t i = 0; i < m_layout.tiles.size(); ++i) {
      m_dissipated += weight * (m_sweepSums[i].power + m_sweepSums[i].drag);
      if (!move.predict)
         m_work += (move.stage ? weight : move.drift) * m_sweepSums[i].load;
      if (visits) {
         m_dissipated += m_visits[i].sums.dissipated;
         m_work += m_visits[i].sums.work;
      }
   }
}

template<typename T>
void VectorMotion<T>::halfDrift(const sdk::Call &call, double dt)
{
   const auto tiles = static_cast<std::int64_t>(m_layout.tiles.size());
   auto run = [&](std::int64_t begin, std::int64_t end) {
      const FlushDenormals mode;
      for (std::int64_t i = begin; i < end; ++i) {
         const Tile &tile = m_layout.tiles[static_cast<std::size_t>(i)];
         Sums &sums = m_visits[static_cast<std::size_t>(i)].sums;
         sums = {};
         if (m_assembly->hasFriction)
            gripMoves(sums, tile.cells, tile.cellsEnd, dt);
         for (std::uint32_t place = tile.cells; m_sweep.loads && place < tile.cellsEnd; ++place)
            for (int k = 0; k < 6; ++k)
               sums.work += dt * static_cast<double>(
                                     m_sweep.loads[static_cast<std::size_t>(k) * m_sweep.stride + place] *
                                     column(7 + k)[place]);
         m_kernel.drift(m_sweep, tile, dt);
      }
   };
   if (tiles > 1)
      call.parallelFor(tiles, 1, run);
   else
      run(0, tiles);
   for (const Visit &visit : m_visits) {
      m_dissipated += visit.sums.dissipated;
      m_work += visit.sums.work;
   }
}

template<typename T>
void VectorMotion<T>::inStages(const sdk::Call &call, double time, double dt)
{
   const auto stages = stagesOf(m_integrator);
   for (std::size_t i = 0; i < stages.size(); ++i) {
      const Stage &stage = stages[i];
      if (m_actuation.active()) {
         m_actuation.setRest(time + stage.ahead * dt, m_rest);
         restChanged();
      }
      Move move;
      move.drift = dt;
      move.stage = true;
      move.first = i == 0;
      move.last = i + 1 == stages.size();
      move.weight = stage.weight;
      move.next = stage.next * dt;
      sweep(call, move, stage.weight * dt, stage.ahead * dt);
   }
}

template<typename T>
void VectorMotion<T>::advance(const sdk::Call &call, double time, double dt)
{
   m_stale = true;
   for (DrivenPlace &driven : m_drivenPlaces) {
      pull(driven.led.cell);
      for (int k = 0; k < 6; ++k)
         driven.before[k] = m_state.column(7 + k)[driven.led.cell];
   }
   if (m_drive.active())
      m_drive.lead(*m_assembly, time, dt, m_state);
   if (m_integrator == Options::Integrator::semiImplicit) {
      sweep(call, {.kick = dt, .drift = dt}, dt);
      m_behind = 0.5 * dt;
   } else {
      for (const DrivenPlace &driven : m_drivenPlaces)
         push(driven.led.cell);
   }
   if (!stagesOf(m_integrator).empty())
      inStages(call, time, dt);
   if (m_integrator == Options::Integrator::verlet) {
      halfDrift(call, 0.5 * dt);
      if (m_actuation.active()) {
         m_actuation.setRest(time + 0.5 * dt, m_rest);
         restChanged();
      }
      if (!m_rates.empty()) {
         std::copy_n(column(7), 6 * m_sweep.stride, m_rates.begin()); // what dampers see at first
         sweep(call, {.kick = 0.5 * dt, .predict = true}, 0);
      }
      sweep(call, {.kick = dt, .drift = 0.5 * dt}, dt);
   }
   if (!m_drive.active())
      return;
   for (const DrivenPlace &driven : m_drivenPlaces)
      pull(driven.led.cell);
   m_work += m_drive.arrive(*m_assembly, dt, m_state);
   for (const DrivenPlace &driven : m_drivenPlaces)
      push(driven.led.cell);
}

template class VectorMotion<float>;
template class VectorMotion<double>;

} // namespace bonds
