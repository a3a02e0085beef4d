#include "study/stability_scenes.h"

#include <cmath>
#include <random>

namespace diatom::stability {

namespace {

Cell added(Design &design, const Material &material)
{
   const auto index = design.model.setMaterial(material);
   return Cell{index ? *index : MaterialIndex{0}, 0, 0};
}

} // namespace

Material stuff(const char *id, double density, double youngsModulus, double dampingRatio)
{
   Material material;
   material.id = material.name = id;
   material.density = density;
   material.youngsModulus = youngsModulus;
   material.dampingRatio = dampingRatio;
   return material;
}

Material rubber(double dampingRatio) { return stuff("rubber", 1200, 2e6, dampingRatio); }
Material aluminium() { return stuff("aluminium", 2700, 69e9); }
Material steel() { return stuff("steel", 7850, 210e9); }

double soundSpeed(const Material &material) { return std::sqrt(material.youngsModulus / material.density); }

Design block(Index size, const Material &material)
{
   Design design;
   design.name = "hard case";
   design.model.lattice.pitch = kPitch;
   design.model.root.cells.fill({{0, 0, 0}, {size.x - 1, size.y - 1, size.z - 1}}, added(design, material));
   return design;
}

Design halves(Index size, const Material &lower, const Material &upper)
{
   Design design = block(size, lower);
   design.model.root.cells.fill({{size.x / 2, 0, 0}, {size.x - 1, size.y - 1, size.z - 1}},
                                added(design, upper));
   return design;
}

Box layer(Index size, int axis, std::int32_t at)
{
   Box box{{0, 0, 0}, {size.x - 1, size.y - 1, size.z - 1}};
   std::int32_t Index::*along = axis == 0 ? &Index::x : axis == 1 ? &Index::y : &Index::z;
   box.min.*along = box.max.*along = at;
   return box;
}

void hold(Design &design, const Box &where) { design.setup.supports.push_back({where, kAllFreedoms}); }

void shake(Design &design, Index size, double speed, std::uint32_t seed)
{
   std::mt19937 random(seed);
   const auto draw = [&] {
      return speed * (2 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1);
   };
   for (std::int32_t x = 0; x < size.x; ++x)
      for (std::int32_t y = 0; y < size.y; ++y)
         for (std::int32_t z = 0; z < size.z; ++z) {
            Start start;
            start.where = Index{x, y, z};
            start.velocity = {draw(), draw(), draw()};
            design.setup.starts.push_back(start);
         }
}

void kick(Design &design, Index size, double speed)
{
   Start start;
   start.where = Box{{size.x / 2, 0, 0}, {size.x - 1, size.y - 1, size.z - 1}};
   start.velocity = {0, 0.8 * speed, 0.6 * speed};
   design.setup.starts.push_back(start);
}

void spin(Design &design, Index size, double rate)
{
   Start start;
   start.where = Box{{0, 0, 0}, {size.x - 1, size.y - 1, size.z - 1}};
   start.spin = {0, 0, rate};
   start.about = {(size.x - 1) * kPitch / 2, (size.y - 1) * kPitch / 2, (size.z - 1) * kPitch / 2};
   design.setup.starts.push_back(start);
}

void bendToArc(Design &design, int cells, double angle)
{
   const double step = angle / (cells - 1);
   double x = 0, z = 0;
   for (int i = 1; i < cells; ++i) {
      // Upwards is a turn about -y; each bond lies along its middle frame.
      x += kPitch * std::cos((i - 0.5) * step);
      z += kPitch * std::sin((i - 0.5) * step);
      Start start;
      start.where = Index{i, 0, 0};
      start.displacement = {x - i * kPitch, 0, z};
      start.turn = {0, -i * step, 0};
      design.setup.starts.push_back(start);
   }
}

Design drivenRow(int cells, Waveform wave, double hertz, double strain, const Material &muscle)
{
   // Three rows along x: a conductor on one net, the actuators, a conductor on the other; a source joins the
   // two at their end.
   Material wire = rubber(muscle.dampingRatio);
   wire.id = wire.name = "wire";
   wire.role = ElectricalRole::conductor;
   Material source = wire;
   source.id = source.name = "battery";
   source.role = ElectricalRole::source;
   Material driven = muscle;
   driven.role = ElectricalRole::actuator;
   driven.actuation = {Actuation::Mode::axial, 0, strain, false};
   driven.ports = 0x0c; // the faces across y
   source.ports = 0x0c;
   Design design = block({cells, 1, 1}, driven);
   CellArray &at = design.model.root.cells;
   const Cell conductor = added(design, wire);
   at.fill({{0, -1, 0}, {cells, -1, 0}}, conductor);
   at.fill({{0, 1, 0}, {cells, 1, 0}}, conductor);
   at.set({cells, 0, 0}, added(design, source));
   Source signal;
   signal.cell = {cells, 0, 0};
   signal.waveform = wave;
   signal.frequency = hertz;
   signal.amplitude = 2; // V, peak to peak
   design.setup.sources = {signal};
   hold(design, {{0, -1, 0}, {0, 1, 0}});
   hold(design, {{cells, -1, 0}, {cells, 1, 0}});
   return design;
}

Design shakenHalves(double ratio)
{
   const Index size{12, 2, 2};
   Material hard = rubber();
   hard.id = hard.name = "hard";
   hard.youngsModulus *= ratio;
   Design design = halves(size, rubber(), hard);
   shake(design, size, 1e-2 * soundSpeed(rubber()), 1);
   return design;
}

Design shakenMetals()
{
   const Index size{12, 2, 2};
   Design design = halves(size, steel(), aluminium());
   shake(design, size, 1, 3);
   return design;
}

Design spinningCube(double ofSound)
{
   const Index size{5, 5, 5};
   Design design = block(size, rubber());
   spin(design, size, ofSound * soundSpeed(rubber()) / (2.5 * kPitch));
   return design;
}

Design releasedBeam()
{
   const Index size{40, 1, 1};
   Design design = block(size, rubber());
   hold(design, layer(size, 0, 0));
   bendToArc(design, size.x, 1.0471975511965976);
   return design;
}

} // namespace diatom::stability
