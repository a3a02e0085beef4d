// Motion in time of bonds and cells by the vector kernel, in single or double precision.
#pragma once

#include "explicit/layout.h"
#include "explicit/motion.h"
#include "explicit/pages.h"
#include "model/contact.h"

#include <optional>

namespace bonds {

/// Why the vector kernel cannot move a scene; nothing when it can.
std::optional<std::string> whyNotVector(const Assembly &assembly, const Couplings &couplings,
                                        const Options &options);

template<typename T>
class VectorMotion : public Motion
{
public:
   VectorMotion(const sdk::SceneView &scene, const Assembly &assembly, const Couplings &couplings,
                const Options &options);

   void setLoads(const sdk::Channel &loads) override;
   void gravityChanged() override;
   Moving moving() const override;
   void save(double time) override;
   double restore() override;
   std::string how() const override;

private:
   void takeCells();
   void takeBoxes();
   void takeBonds();
   void makeRooms();
   void advance(const sdk::Call &call, double time, double dt) override;
   void readState() const override;
   void readActuated() const override;
   void restChanged() override;

   /// What happens to single cells in the middle of a tile.
   struct Visit
   {
      VectorMotion *motion = nullptr;
      Move move;
      double weight = 0; // s, of what is dissipated
      double ahead = 0;  // s, of the step's start: friction's springs stand there
      Sums sums;
   };
   void sweep(const sdk::Call &call, const Move &move, double weight, double ahead = 0);
   void visitBefore(Visit &visit, std::uint32_t begin, std::uint32_t end, T *lo, const T *hi,
                    std::size_t hiStride);
   bool findTouching(std::uint32_t begin, std::uint32_t count, std::uint8_t *touches, bool gripping) const;
   bool grips(std::int64_t cell) const { return m_state.grip[0][cell] != 0 || m_state.grip[1][cell] != 0; }
   Touch touchAt(std::uint32_t place, std::int64_t cell, const T *speeds);
   void visitTouching(Visit &visit, std::uint32_t begin, std::uint32_t end, T *lo);
   void visitDriven(Visit &visit, std::uint32_t place, const T *lo, const T *hi, std::size_t hiStride);
   void gripMoves(Sums &sums, std::uint32_t begin, std::uint32_t end, double dt);
   void inStages(const sdk::Call &call, double time, double dt);
   void halfDrift(const sdk::Call &call, double dt);
   /// One cell from the columns to m_state; and back.
   void pull(std::int64_t cell) const;
   void push(std::int64_t cell);

   T *column(int k) { return m_columns.data() + static_cast<std::size_t>(k) * m_sweep.stride; }
   const T *column(int k) const { return m_columns.data() + static_cast<std::size_t>(k) * m_sweep.stride; }

   Layout m_layout;
   SweepKernel<T> m_kernel;
   SweepWork<T> m_sweep;
   PageVector<T> m_columns, m_rates, m_inverseMass, m_inverseInertia, m_pool, m_frames, m_restShape, m_slots,
       m_loadColumns, m_touching, m_start, m_sum, m_boxes, m_savedColumns;
   PageVector<T> m_rooms;             // of tiles, one after another
   std::vector<std::size_t> m_roomAt; // of each tile
   std::vector<std::uint8_t> m_heldPlaces;
   std::vector<std::uint8_t> m_gripping; // places whose cell's friction springs are stretched
   std::vector<std::int64_t> m_actuatedCells;
   std::vector<Visit> m_visits; // of tiles
   std::vector<SweepSums> m_sweepSums;
   struct DrivenPlace
   {
      std::uint32_t place;
      Drive::Led led;
      std::array<double, 6> before; // velocities
   };
   std::vector<DrivenPlace> m_drivenPlaces; // ascending
   mutable bool m_stale = false;            // m_state is older than the columns
};

extern template class VectorMotion<float>;
extern template class VectorMotion<double>;

} // namespace bonds
