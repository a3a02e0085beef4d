#include "study/accuracy_samples.h"

#include "study/beam_theory.h"

#include <cmath>
#include <numbers>

namespace diatom {

namespace {

constexpr double kPitch = 1e-3; // m
constexpr double kGravity = 9.81;

Material stuff(const std::string &id, double density, double youngsModulus)
{
   Material material;
   material.id = material.name = id;
   material.density = density;
   material.youngsModulus = youngsModulus;
   return material;
}

MaterialIndex added(Model &model, const Material &material)
{
   const auto index = model.setMaterial(material);
   return index ? *index : MaterialIndex{0};
}

/// A bar of one row of cells along x, the first of them clamped: the bar begins at that cell's centre, and
/// its last cell's far half hangs over.
struct Row
{
   int bonds;
   Material material;

   double span() const { return bonds * kPitch; } // to the centre of the last cell
   Index tip() const { return {bonds, 0, 0}; }
   Bar bar(double length) const
   {
      return Bar::square(length, kPitch, material.youngsModulus, material.poissonRatio, material.density);
   }
   Bar whole() const { return bar(span() + kPitch / 2); }

   Design design(const std::string &name) const
   {
      Design made;
      made.name = name;
      made.model.lattice.pitch = kPitch;
      const MaterialIndex index = added(made.model, material);
      made.model.root.cells.fill({{0, 0, 0}, tip()}, Cell{index, 0, 0});
      made.setup.supports = {{Index{0, 0, 0}, kAllFreedoms}};
      return made;
   }
};

/// Motion dies away fastest without swinging on where the drag is twice the lowest frequency (rad/s).
double settlingDrag(const Bar &bar) { return 4 * std::numbers::pi * bendingFrequency(bar); }

/// s: the slowest part of a motion under settlingDrag() falls as (1 + w t) exp(-w t), to 1e-7 of itself here.
double settlingTime(double drag) { return 20 / (drag / 2); }

AccuracySample sag()
{
   const Row row{20, stuff("plastic", 1200, 2e9)};
   AccuracySample sample{"sag", "Sag of a slender cantilever under its own weight", row.design("sag"), {}};
   Setup &setup = sample.design.setup;
   setup.gravity = {0, 0, -kGravity};
   setup.drag = settlingDrag(row.whole());
   sample.request.until = settlingTime(setup.drag);
   const double weight = row.material.density * kPitch * kPitch * kGravity;
   setup.references = {{"20,0,0:z@rest", -sagOf(row.whole(), weight, row.span()),
                        "Timoshenko's beam under its distributed weight"}};
   return sample;
}

AccuracySample elastica()
{
   const Row row{16, stuff("rubber", 1200, 2e6)};
   AccuracySample sample{
       "elastica", "A rubber bar bent through 69 degrees by a force at its tip", row.design("elastica"), {}};
   Setup &setup = sample.design.setup;
   const Bar bar = row.bar(row.span());
   const double force = 5 * bar.bending / (bar.length * bar.length);
   setup.loads = {{row.tip(), {0, 0, force}, {}}};
   setup.drag = settlingDrag(row.whole());
   sample.request.until = settlingTime(setup.drag);
   setup.references = {
       {"16,0,0:z@rest", bentTip(bar, force).across, "Reissner's beam, integrated along its length"}};
   return sample;
}

AccuracySample frequency()
{
   constexpr double kAmplitude = 1e-3; // of the length: large rotations shift the frequency by its square
   constexpr double kSwings = 8.5;
   const Row row{12, stuff("plastic", 1200, 2e9)};
   AccuracySample sample{
       "frequency", "Lowest frequency of a bar that swings freely", row.design("frequency"), {}};
   const Bar bar = row.whole();
   const double hertz = bendingFrequency(bar);
   Setup &setup = sample.design.setup;
   for (int i = 1; i <= row.bonds; ++i) {
      const BarShape shape = bendingShape(bar, hertz, i * kPitch);
      // Set out from the straight: the speed that carries the tip that far.
      const double speed = kAmplitude * row.span() * 2 * std::numbers::pi * hertz;
      Start start;
      start.where = Index{i, 0, 0};
      start.velocity = {0, 0, speed * shape.deflection};
      start.spin = {0, -speed * shape.turn, 0}; // upwards is a turn about -y
      setup.starts.push_back(start);
   }
   sample.request.until = kSwings / hertz;
   setup.references = {{"12,0,0:z@frequency", hertz, "Timoshenko's beam, clamped and free"}};
   return sample;
}

Material wired(const std::string &id, double density, double youngsModulus, double dampingRatio,
               ElectricalRole role)
{
   Material material = stuff(id, density, youngsModulus);
   material.dampingRatio = dampingRatio;
   material.role = role;
   return material;
}

/// The walker among the sample designs, by the same materials and signal.
AccuracySample stride()
{
   constexpr double kSteps = 5; // of the walker, after which it has found its gait
   constexpr double kHertz = 50;
   AccuracySample sample{"stride", "Way of a walker on the ground in five steps", {}, {}};
   Design &design = sample.design;
   design.name = "stride";
   design.model.lattice.pitch = kPitch;
   Material actuator = wired("actuator", 6500, 2e5, 0.1, ElectricalRole::actuator);
   actuator.actuation = {Actuation::Mode::axial, 0, 0.6, true};
   Model &model = design.model;
   const Cell hard{added(model, wired("conductor", 8500, 5e5, 0.1, ElectricalRole::conductor)), 0, 0};
   const Cell soft{added(model, wired("flexible", 3500, 3e4, 0.2, ElectricalRole::conductor)), 0, 0};
   const Cell muscle{added(model, actuator), 0, 0};
   const Cell source{added(model, wired("source", 6500, 2e5, 0.1, ElectricalRole::source)), 0, 0};
   CellArray &cells = model.root.cells;
   cells.fill({{0, 0, 0}, {2, 1, 1}}, hard);
   cells.fill({{0, 3, 0}, {2, 5, 1}}, hard);
   cells.set({1, 2, 1}, soft);
   cells.set({0, 2, 0}, muscle);
   cells.set({2, 2, 0}, muscle);
   cells.set({1, 4, 2}, source);
   Source signal;
   signal.cell = {1, 4, 2};
   signal.waveform = Waveform::saw;
   signal.frequency = kHertz;
   design.setup.sources = {signal};
   design.setup.gravity = {0, 0, -9.8};
   design.setup.ground.present = true;
   design.setup.ground.height = -kPitch / 2;
   sample.request.until = kSteps / kHertz;
   Quantity way;
   way.cell = {1, 1, 0};
   way.channel = "y";
   way.when = Quantity::When::atTime;
   way.time = sample.request.until;
   sample.request.quantity = way;
   return sample;
}

/// Shear flexure after figure 7-4 of the thesis: two plates joined by two legs with a hinge at either end of
/// each, 27 cells. A hinge bends like a blade a tenth of a cell thick, and is a cube of a softer stuff here,
/// so that it can be cut into smaller cells.
Design flexureOf(const std::string &name, double density, double youngsModulus)
{
   Design design;
   design.name = name;
   design.model.lattice.pitch = kPitch;
   const Cell stiff{added(design.model, stuff("stiff", density, youngsModulus)), 0, 0};
   const Cell hinge{added(design.model, stuff("hinge", density, 1e-3 * youngsModulus)), 0, 0};
   CellArray &cells = design.model.root.cells;
   cells.fill({{0, 0, 0}, {0, 5, 0}}, stiff);
   cells.fill({{8, 0, 0}, {8, 6, 0}}, stiff);
   for (const int y : {0, 5}) {
      cells.fill({{1, y, 0}, {7, y, 0}}, stiff);
      cells.set({1, y, 0}, hinge);
      cells.set({7, y, 0}, hinge);
   }
   return design;
}

AccuracySample flexure()
{
   constexpr double kStiff = 2e9;
   AccuracySample sample{"flexure",
                         "Shear flexure of figure 7-4, its cells cut into 1, 8 and 27",
                         flexureOf("flexure", 1000, kStiff),
                         {}};
   Setup &setup = sample.design.setup;
   setup.supports = {{Box{{0, 0, 0}, {0, 5, 0}}, kAllFreedoms}};
   setup.loads = {{Index{8, 6, 0}, {0, 0.012, 0}, {}}};
   // Pseudo-rigid body: legs 6 mm between hinges of bending stiffness E l^3 / 12; the free plate's mass and a
   // third of the legs'.
   const double stiffness = 4 * (1e-3 * kStiff * std::pow(kPitch, 3) / 12) / std::pow(6 * kPitch, 2);
   const double mass = (7 + 14.0 / 3) * 1000 * std::pow(kPitch, 3);
   setup.drag = 2 * std::sqrt(stiffness / mass);
   sample.request.until = settlingTime(setup.drag);
   sample.request.resolutions = {1, 2, 3};
   sample.request.models = {CellModel::block, CellModel::solid};
   // Elements at 2, 4 and 8 to a cell's edge give 0.64538, 0.65170 and 0.65454 mm: order 1.2, as the corners
   // where stiff meets soft allow.
   setup.references = {
       {"8,6,0:y@rest", 0.6568e-3,
        "CalculiX 2.20, large deformations, extrapolated from 8 C3D20R elements along a cell; "
        "good to 0.3 %"}};
   return sample;
}

/// The same of aluminium, whose foot is moved smoothly by a millimetre: slow beside its stiffest bond, whose
/// oscillation takes 0.6 us.
AccuracySample stiffFlexure()
{
   constexpr double kTime = 0.01, kWay = 1e-3; // s, m
   constexpr int kPoints = 1000;
   AccuracySample sample{"stiff-flexure",
                         "Aluminium flexure of 1 mm cells, its foot moved by 1 mm in 10 ms",
                         flexureOf("stiff-flexure", 2700, 69e9),
                         {}};
   Curve smooth;
   for (int k = 0; k <= kPoints; ++k) {
      const double part = static_cast<double>(k) / kPoints;
      smooth.push_back({kTime * part, kWay / 2 * (1 - std::cos(std::numbers::pi * part))});
   }
   const Box foot{{0, 0, 0}, {0, 5, 0}};
   Setup &setup = sample.design.setup;
   setup.supports = {{foot, 0x3d}}; // all but y
   setup.drives = {{foot, 1, smooth}};
   sample.request.until = kTime;
   Quantity tip;
   tip.cell = {8, 6, 0};
   tip.channel = "y";
   tip.when = Quantity::When::atTime;
   tip.time = kTime;
   sample.request.quantity = tip;
   return sample;
}

} // namespace

std::vector<AccuracySample> accuracySamples()
{
   return {sag(), elastica(), frequency(), stride(), flexure(), stiffFlexure()};
}

} // namespace diatom
