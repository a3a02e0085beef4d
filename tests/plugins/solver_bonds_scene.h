// Hand-made scenes for the bond solver and the smallest host that can drive its C table.
#pragma once

#include "support/support.h"

#include <diatom/abi/solver.h>

#include <dlfcn.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace diatom::test {

/// A host of one or two threads that remembers what it was told.
struct Host
{
   explicit Host(int threadCount = 1) : threads(threadCount)
   {
      call = {sizeof(diatom_call), this, report, cancelled, progress, parallelFor, nullptr, nullptr};
   }
   static Host *self(const diatom_call *call) { return static_cast<Host *>(call->host); }
   static void report(const diatom_call *call, std::int32_t, const char *text) { self(call)->said += text; }
   static std::int32_t cancelled(const diatom_call *call) { return self(call)->cancel ? 1 : 0; }
   static void progress(const diatom_call *, double, const char *) {}
   static std::int32_t parallelFor(const diatom_call *call, std::int64_t count, std::int64_t grain,
                                   void (*body)(void *, std::int64_t, std::int64_t), void *context)
   {
      const int threads = self(call)->threads;
      const auto work = [=](int thread) {
         for (std::int64_t i = thread * grain; i < count; i += threads * grain)
            body(context, i, std::min(i + grain, count));
      };
      std::vector<std::thread> others;
      for (int t = 1; t < threads; ++t)
         others.emplace_back(work, t);
      work(0);
      for (std::thread &other : others)
         other.join();
      return DIATOM_OK;
   }

   diatom_call call{};
   int threads;
   bool cancel = false;
   std::string said;
};

/// A scene of cubes, filled by hand; view() points into it.
class HandScene
{
public:
   struct Material
   {
      std::map<std::string, double> property;
   };
   explicit HandScene(double edge) : pitch(edge) {}

   int addMaterial(std::map<std::string, double> property)
   {
      materials.push_back({std::move(property)});
      return static_cast<int>(materials.size()) - 1;
   }
   int addCell(int x, int y, int z, int material = 0)
   {
      at[{x, y, z}] = cells();
      index.insert(index.end(), {x, y, z});
      cellMaterial.push_back(material);
      position.insert(position.end(), {pitch * x, pitch * y, pitch * z});
      orientation.insert(orientation.end(), {1, 0, 0, 0});
      extent.insert(extent.end(), {pitch, pitch, pitch});
      return cells() - 1;
   }
   void addBlock(int nx, int ny, int nz, int material = 0)
   {
      for (int x = 0; x < nx; ++x)
         for (int y = 0; y < ny; ++y)
            for (int z = 0; z < nz; ++z)
               addCell(x, y, z, material);
   }
   /// Bonds between all face neighbours.
   void link()
   {
      for (const auto &[i, cell] : at)
         for (int k = 0; k < 3; ++k) {
            auto next = i;
            ++next[k];
            if (const auto found = at.find(next); found != at.end())
               addLink(cell, found->second, k);
         }
   }
   void addLink(int a, int b, int axis)
   {
      linkA.push_back(a);
      linkB.push_back(b);
      linkAxis.push_back(axis);
   }
   void addRow(const std::string &channel, std::vector<double> row, std::int64_t cell = -1)
   {
      Channel &c = channels[channel];
      c.stride = static_cast<std::int64_t>(row.size());
      c.values.insert(c.values.end(), row.begin(), row.end());
      if (cell >= 0)
         c.where.push_back(cell);
   }
   void fix(int cell, int mask = 63) { addRow("fixed", {double(mask)}, cell); }
   int cells() const { return static_cast<int>(cellMaterial.size()); }

   const diatom_scene &view()
   {
      names.clear();
      values.clear();
      for (const Material &m : materials)
         for (const auto &[name, value] : m.property)
            if (std::find(names.begin(), names.end(), name) == names.end())
               names.push_back(name);
      for (const Material &m : materials)
         for (const std::string &name : names)
            values.push_back(m.property.count(name) ? m.property.at(name) : std::nan(""));
      namePointers.clear();
      for (const std::string &name : names)
         namePointers.push_back(name.c_str());
      channelViews.clear();
      for (const auto &[name, c] : channels)
         channelViews.push_back({name.c_str(), static_cast<std::int64_t>(c.values.size()) / c.stride,
                                 c.stride, c.where.empty() ? nullptr : c.where.data(), c.values.data()});
      effectPointers.clear();
      for (const std::string &effect : effects)
         effectPointers.push_back(effect.c_str());
      scene = {sizeof(diatom_scene),
               pitch,
               cells(),
               index.data(),
               cellMaterial.data(),
               position.data(),
               orientation.data(),
               extent.data(),
               static_cast<std::int64_t>(linkA.size()),
               linkA.data(),
               linkB.data(),
               linkAxis.data(),
               static_cast<std::int32_t>(materials.size()),
               static_cast<std::int32_t>(names.size()),
               namePointers.data(),
               values.data(),
               static_cast<std::int64_t>(channelViews.size()),
               channelViews.data(),
               static_cast<std::int64_t>(effectPointers.size()),
               effectPointers.data(),
               analysis.c_str()};
      return scene;
   }

   struct Channel
   {
      std::int64_t stride = 1;
      std::vector<std::int64_t> where;
      std::vector<double> values;
   };
   double pitch;
   std::vector<Material> materials;
   std::map<std::array<int, 3>, int> at;
   std::vector<std::int32_t> index, cellMaterial, linkA, linkB, linkAxis;
   std::vector<double> position, orientation, extent;
   std::map<std::string, Channel> channels;
   std::vector<std::string> effects{"rotation"};
   std::string analysis = "dynamics";

private:
   diatom_scene scene{};
   std::vector<std::string> names;
   std::vector<const char *> namePointers, effectPointers;
   std::vector<double> values;
   std::vector<diatom_channel> channelViews;
};

/// All cells move at random, `speed` m/s and as much at their rims.
inline void kickAll(HandScene &scene, double speed, unsigned seed = 7)
{
   std::mt19937_64 random(seed);
   std::uniform_real_distribution<double> unit(-1, 1);
   for (int i = 0; i < scene.cells(); ++i) {
      std::vector<double> row;
      for (int k = 0; k < 6; ++k)
         row.push_back(unit(random) * speed * (k < 3 ? 1 : 2 / scene.pitch));
      scene.addRow("velocity", row, i);
   }
}

/// The plugin's table.
inline const diatom_solver *bondSolver()
{
   const auto path = binaryDir() / "plugins" / "solvers" / "bonds" / "bonds.so";
   void *library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
   if (!library)
      return nullptr;
   const auto *module = static_cast<const diatom_module *>(dlsym(library, DIATOM_MODULE_SYMBOL));
   return module ? static_cast<const diatom_solver *>(module->get(DIATOM_SOLVER_1)) : nullptr;
}

struct SolverChoice
{
   std::string integrator = "semi_implicit", beam = "timoshenko", gradient = "exact";
   double safety = 0.9, forceStep = 0;
   double loadSteps = 0, modes = 10;
   std::string precision = "f64";
   double reproducible = 0;
   std::string instructions = "best";
   double numericalDamping = 0.2, stepTolerance = 1e-3;
   std::string junction = "stepped", modesFrom = "lowest", stableStep = "bound";
};

/// A running solver.
class Run
{
public:
   explicit Run(HandScene &scene, const SolverChoice &choice = {}, int threads = 1, bool cancelled = false)
       : host(threads)
   {
      host.cancel = cancelled;
      struct Value
      {
         const char *name;
         double number;
         const char *text;
      };
      const Value all[] = {{"integrator", 0, choice.integrator.c_str()},
                           {"beam", 0, choice.beam.c_str()},
                           {"gradient", 0, choice.gradient.c_str()},
                           {"safety", choice.safety, ""},
                           {"force_step", choice.forceStep, ""},
                           {"load_steps", choice.loadSteps, ""},
                           {"modes", choice.modes, ""},
                           {"precision", 0, choice.precision.c_str()},
                           {"reproducible", choice.reproducible, ""},
                           {"instructions", 0, choice.instructions.c_str()},
                           {"numerical_damping", choice.numericalDamping, ""},
                           {"step_tolerance", choice.stepTolerance, ""},
                           {"junction", 0, choice.junction.c_str()},
                           {"modes_from", 0, choice.modesFrom.c_str()},
                           {"stable_step", 0, choice.stableStep.c_str()}};
      std::vector<const char *> names, texts;
      std::vector<double> numbers;
      for (const Value &one : all) {
         names.push_back(one.name);
         numbers.push_back(one.number);
         texts.push_back(one.text);
      }
      const diatom_values values{sizeof(diatom_values), static_cast<std::int64_t>(names.size()), names.data(),
                                 numbers.data(), texts.data()};
      const diatom_create create{sizeof(diatom_create), "org.diatom_cad.solver.bonds", "", &values};
      estimate.size = sizeof estimate;
      if (!table) {
         status = DIATOM_INTERNAL;
         host.said = "plugins/solvers/bonds/bonds.so is not in the build folder that DIATOM_BINARY_DIR names";
         return;
      }
      status = table->estimate(&host.call, &create, &scene.view(), &estimate);
      if (status == DIATOM_OK)
         status = table->create(&host.call, &create, &scene.view(), &self);
   }
   ~Run()
   {
      if (self)
         table->destroy(self);
   }
   Run(const Run &) = delete;
   Run &operator=(const Run &) = delete;

   std::int32_t to(double until, double step = 0, std::int64_t most = 0)
   {
      const diatom_step_request request{sizeof(diatom_step_request), until, step, most, 0};
      result.size = sizeof result;
      return status = table->step(self, &host.call, &request, &result);
   }
   /// All rows of an output.
   std::vector<double> read(const std::string &name)
   {
      const diatom_outputs *outputs = nullptr;
      table->outputs(self, &host.call, &outputs);
      for (std::int64_t i = 0; i < outputs->count; ++i)
         if (name == outputs->output[i].name) {
            std::vector<double> values(
                static_cast<std::size_t>(outputs->output[i].count * outputs->output[i].stride));
            status = table->read(self, &host.call, i, 0, outputs->output[i].count, values.data());
            return values;
         }
      return {};
   }
   double stored()
   {
      const auto e = read("energy");
      return e[0] + e[1] + e[2] + e[3];
   }
   /// stored + dissipated - work
   double balance()
   {
      const auto e = read("energy");
      return e[0] + e[1] + e[2] + e[3] + e[4] - e[5];
   }

   const diatom_solver *table = bondSolver();
   Host host;
   void *self = nullptr;
   std::int32_t status = DIATOM_OK;
   diatom_estimate estimate{};
   diatom_step_result result{};
};

/// A material with the fifteen constants of a validation file's "k" object.
template<typename Json>
std::map<std::string, double> fifteen(const Json &k, double density, double dampingRatio = 0)
{
   std::map<std::string, double> out{{"density", density}, {"damping_ratio", dampingRatio}};
   const std::string axes = "xyz";
   for (std::size_t i = 0; i < 3; ++i) {
      out[std::string("axial_") + axes[i]] = k.at("axial").at(i).template get<double>();
      out[std::string("bending_") + axes[i]] = k.at("bending").at(i).template get<double>();
      out[std::string("torsion_") + axes[i]] = k.at("torsion").at(i).template get<double>();
   }
   for (const auto &[name, value] : k.at("shear").items())
      out["shear_" + name] = value.template get<double>();
   return out;
}

} // namespace diatom::test
