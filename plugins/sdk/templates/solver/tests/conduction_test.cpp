// Steady conduction against answers from a sheet of paper; needs nothing of Diatom but the SDK.
#include "../conduction.hpp"

#include <diatom/testing.hpp>

#include <cstdio>

using namespace diatom::sdk;
using conduction::Conduction;

namespace {

int faults = 0;

void near(const char *what, double found, double expected, double tolerance)
{
   if (std::abs(found - expected) <= tolerance)
      return;
   std::printf("%s is %.17g, expected %.17g +- %g\n", what, found, expected, tolerance);
   ++faults;
}

std::vector<double> solved(TestScene &scene, TestHost &host, std::int64_t output = 0)
{
   const diatom_values none{sizeof none, 0, nullptr, nullptr, nullptr};
   Conduction solver(host.call(), Values(&none), SceneView(scene.view("statics")));
   const diatom_step_request request{sizeof request, 0, 0, 100000, 1e-12};
   diatom_step_result result{};
   if (solver.step(host.call(), request, result) != DIATOM_OK || result.state != DIATOM_CONVERGED)
      near("the state", static_cast<double>(result.state), DIATOM_CONVERGED, 0);
   std::vector<double> values(static_cast<std::size_t>(solver.outputs().output[output].count));
   solver.read(host.call(), output, 0, static_cast<std::int64_t>(values.size()), values.data());
   return values;
}

/// Cells of 1 mm along x with 0.5 W/(m K): each link conducts 0.5e-3 W/K.
TestScene bar(int cells)
{
   TestScene scene(1e-3);
   for (int x = 0; x < cells; ++x)
      scene.cell(x, 0, 0);
   scene.property("thermal_conductivity", {0.5});
   return scene;
}

/// T falls by 10 K from cell to cell; the search ends at 1e-12 of the heat that flows, which over ten links
/// in a row is some 1e-9 K at most.
void temperatureFallsEvenlyAlongABar()
{
   TestHost host;
   TestScene scene = bar(11);
   scene.set("temperature", 0, {400});
   scene.set("temperature", 10, {300});
   const auto temperature = solved(scene, host), heat = solved(scene, host, 2);
   for (std::size_t x = 0; x <= 10; ++x)
      near("a temperature", temperature[x], 400 - 10.0 * static_cast<double>(x), 1e-8);
   for (const double flow : heat)
      near("the heat in a link", flow, 5e-3, 1e-11);
   near("the heat supplied", solved(scene, host, 1)[0], 5e-3, 1e-11);
}

/// Copper beside plastic: halves in series, so that the drop is all in the plastic but for one part in a
/// thousand.
void unlikeCellsConductInSeries()
{
   TestHost host;
   TestScene scene(1e-3);
   scene.cell(0, 0, 0, 0);
   scene.cell(1, 0, 0, 1);
   scene.property("thermal_conductivity", {400, 0.4});
   scene.set("temperature", 0, {310});
   scene.set("temperature", 1, {300});
   // 10 K / (0.5e-3 / (400 * 1e-6) + 0.5e-3 / (0.4 * 1e-6)); rounding only.
   near("the heat", solved(scene, host, 2)[0], 10 / (1.25 + 1250), 1e-15);
}

/// Ten cells that each release 1 mW, one end held: flows 10, 9, ... 1 mW; in a row of links T is the sum of
/// the flows over the conductance.
void sourcesAddUp()
{
   TestHost host;
   TestScene scene = bar(11);
   scene.set("temperature", 0, {300});
   for (int x = 1; x <= 10; ++x)
      for (int half = 0; half < 2; ++half)
         scene.set("heat", x, {0.5e-3});
   const auto temperature = solved(scene, host);
   double expected = 300;
   for (std::size_t x = 1; x <= 10; ++x) {
      expected += (11.0 - static_cast<double>(x)) * 1e-3 / 0.5e-3;
      near("a temperature", temperature[x], expected, 1e-8);
   }
}

/// The same bits whatever the order in which the pieces of a parallel loop run.
void orderDoesNotShow()
{
   TestHost forwards, backwards;
   backwards.backwards = true;
   TestScene scene(1e-3);
   for (int x = 0; x < 30; ++x)
      for (int y = 0; y < 30; ++y)
         for (int z = 0; z < 10; ++z)
            scene.cell(x, y, z);
   scene.property("thermal_conductivity", {0.5});
   scene.set("temperature", 0, {300});
   scene.set("heat", 8999, {1e-3});
   if (solved(scene, forwards) != solved(scene, backwards))
      near("the difference", 1, 0, 0);
}

void aBodyWithoutATemperatureIsRefused()
{
   TestHost host;
   TestScene scene = bar(3);
   try {
      solved(scene, host);
      near("the refusals", 0, 1, 0);
   } catch (const Failure &failure) {
      near("the status", failure.status(), DIATOM_BAD_INPUT, 0);
   }
}

void cancelStopsTheSearch()
{
   TestHost host;
   TestScene scene = bar(100);
   scene.set("temperature", 0, {400});
   scene.set("heat", 99, {1});
   const diatom_values none{sizeof none, 0, nullptr, nullptr, nullptr};
   Conduction solver(host.call(), Values(&none), SceneView(scene.view("statics")));
   host.cancel = true;
   const diatom_step_request request{sizeof request, 0, 0, 100000, 1e-12};
   diatom_step_result result{};
   near("the status", solver.step(host.call(), request, result), DIATOM_CANCELLED, 0);
}

} // namespace

int main()
{
   temperatureFallsEvenlyAlongABar();
   unlikeCellsConductInSeries();
   sourcesAddUp();
   orderDoesNotShow();
   aBodyWithoutATemperatureIsRefused();
   cancelStopsTheSearch();
   std::printf("%d faults\n", faults);
   return faults == 0 ? 0 : 1;
}
