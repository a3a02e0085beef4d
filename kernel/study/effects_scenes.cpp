#include "study/effects_scenes.h"

namespace diatom {

namespace {

constexpr int kEdge = 12; // cells: 1728 in all, whose state stays in a core's own cache

struct Edit
{
   Design &design;
   Setup &setup;

   explicit Edit(Design &of) : design(of), setup(of.setup) {}
   template<typename Change>
   void material(const Change &change)
   {
      auto all = std::make_shared<std::vector<Material>>(*design.model.materials);
      for (Material &one : *all)
         change(one);
      design.model.materials = all;
   }
};

/// A block held at the bottom, whose upper half sets out sideways.
Design block()
{
   Design made;
   made.name = "block";
   Material rubber;
   rubber.id = rubber.name = "rubber";
   rubber.density = 1200;
   rubber.youngsModulus = 2e6;
   const auto index = made.model.setMaterial(rubber);
   made.model.root.cells.fill({{0, 0, 0}, {kEdge - 1, kEdge - 1, kEdge - 1}},
                              Cell{index ? *index : MaterialIndex{0}, 0, 0});
   made.setup.supports = {{Box{{0, 0, 0}, {kEdge - 1, kEdge - 1, 0}}, kAllFreedoms}};
   Start push;
   push.where = Box{{0, 0, kEdge / 2}, {kEdge - 1, kEdge - 1, kEdge - 1}};
   push.velocity = {0.1, 0.02, 0};
   made.setup.starts = {push};
   return made;
}

/// The block with actuators in every other cell of a plane, between conductors.
Design wiredBlock(bool driven)
{
   Design made = block();
   Material wire;
   wire.id = wire.name = "wire";
   wire.density = 1200;
   wire.youngsModulus = 2e6;
   wire.role = ElectricalRole::conductor;
   Material muscle = wire, battery = wire;
   muscle.id = muscle.name = "muscle";
   muscle.role = ElectricalRole::actuator;
   muscle.actuation = {Actuation::Mode::axial, 0, 0.05, true};
   battery.id = battery.name = "battery";
   battery.role = ElectricalRole::source;
   const auto add = [&](const Material &one) {
      const auto index = made.model.setMaterial(one);
      return Cell{index ? *index : MaterialIndex{0}, 0, 0};
   };
   const Cell conductor = add(wire), actuator = add(muscle), source = add(battery);
   CellArray &cells = made.model.root.cells;
   const int top = kEdge - 1;
   for (int x = 0; x + 2 < kEdge; x += 4) {
      cells.fill({{x, 0, top}, {x, kEdge - 1, top}}, conductor);
      cells.fill({{x + 1, 0, top}, {x + 1, kEdge - 1, top}}, actuator);
      cells.fill({{x + 2, 0, top}, {x + 2, kEdge - 1, top}}, conductor);
      cells.set({x, 0, top}, source);
      Source signal;
      signal.cell = {x, 0, top};
      signal.frequency = 100;
      signal.amplitude = driven ? 1 : 0;
      made.setup.sources.push_back(signal);
   }
   return made;
}

Design grounded(double friction)
{
   Design made = block();
   made.setup.supports.clear();
   made.setup.gravity = {0, 0, -9.81};
   made.setup.ground.present = true;
   made.setup.ground.height = -0.5e-3;
   made.setup.ground.friction = friction;
   return made;
}

template<typename Change>
EffectScene changed(const char *effect, const char *what, Design without, const Change &change)
{
   EffectScene scene{effect, what, without, std::move(without)};
   Edit edit(scene.calledFor);
   change(edit);
   return scene;
}

EffectScene byMaterial(EffectScene scene)
{
   scene.byMaterial = true;
   return scene;
}

/// Switched on, it acts on every material that has a Poisson's ratio, whether it asks for it or not.
EffectScene poisson()
{
   EffectScene scene = changed("poisson", "sideways strain follows axial strain", block(), [](Edit &e) {
      e.material([](Material &one) { one.poissonCoupling = true; });
   });
   scene.nothing = false;
   return scene;
}

} // namespace

std::vector<EffectScene> effectScenes()
{
   Design small = block();
   small.setup.effects["rotation"] = false;
   const Box top{{0, 0, kEdge - 1}, {kEdge - 1, kEdge - 1, kEdge - 1}};
   Design bare = grounded(0);
   bare.setup.ground.present = false;
   return {
       changed("rotation", "strains linear in turns, and exact for any turn", small,
               [](Edit &e) { e.setup.effects.erase("rotation"); }),
       changed("damping", "damping ratio 0.1", block(),
               [](Edit &e) { e.material([](Material &one) { one.dampingRatio = 0.1; }); }),
       changed("gravity", "9.81 m/s2", block(),
               [](Edit &e) {
                  e.setup.gravity = {0, 0, -9.81};
               }),
       changed("actuation", "36 driven actuators", wiredBlock(false),
               [](Edit &e) { e.design = wiredBlock(true); }),
       changed("ground", "free block on a smooth ground", bare,
               [](Edit &e) { e.setup.ground.present = true; }),
       changed("friction", "coefficient 0.5", grounded(0), [](Edit &e) { e.setup.ground.friction = 0.5; }),
       changed("drag", "10 per second", block(), [](Edit &e) { e.setup.drag = 10; }),
       changed("loads", "a force on each of 144 cells", block(),
               [&](Edit &e) {
                  e.setup.loads = {{top, {0, 0, 1e-4}, {}}};
               }),
       changed("driven", "144 cells led along a curve", block(),
               [&](Edit &e) {
                  e.setup.drives = {{top, 2, {{0, 0}, {1, 1e-3}}}};
               }),
       byMaterial(changed("orientation", "constants that differ by direction", block(),
                          [](Edit &e) {
                             e.material([](Material &one) {
                                BondConstants k;
                                k.axial = {2000, 1900, 1800};
                                k.shear = {{{0, 640, 640}, {600, 0, 600}, {560, 560, 0}}};
                                k.bending = {1.6e-4, 1.5e-4, 1.4e-4};
                                k.torsion = {1.2e-4, 1.1e-4, 1e-4};
                                one.bonds = k;
                             });
                          })),
       byMaterial(
           changed("solid", "solid elements instead of bonds", block(),
                   [](Edit &e) { e.material([](Material &one) { one.cellModel = CellModel::solid; }); })),
       poisson(),
   };
}

} // namespace diatom
