// Every installed lattice in two designs, and what independent checkers say of an STL file.
#pragma once

#include "core/file.h"
#include "core/text.h"
#include "io/geometry_file.h"
#include "io/stl.h"
#include "support/mesh.h"
#include "support/process.h"
#include "support/scenes.h"

#include <diatom/abi/lattice.h>
#include <diatom/abi/parts.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace diatom::test {

/// Rows "lattice" x "composite" for all lattices that are installed.
inline void addMatrix()
{
   QTest::addColumn<QString>("lattice");
   QTest::addColumn<bool>("composite");
   for (const Offer &offer : catalogue()->offers(DIATOM_LATTICE_1))
      for (const bool composite : {false, true})
         QTest::newRow((offer.provided->id + (composite ? ", composite" : ", blob")).c_str())
             << QString::fromStdString(offer.provided->id) << composite;
}

/// 500 cells at random, or a composite of composites that touch; three materials. With a height for lattices
/// that have one.
inline Scene matrixScene(const std::string &lattice, bool composite, double height = 0)
{
   Scene scene(lattice, 1e-3, height > 0 ? Values{{"height", height}} : Values{});
   if (!composite) {
      for (const Index i : blob(*scene.lattice, 500, 17))
         scene.model.root.cells.set(i, {static_cast<MaterialIndex>(1 + floorMod(i.x + i.z, 3)), 0, 0});
      return scene;
   }
   // Steps by whole periods keep every site what it is.
   const auto period = scene.lattice->period();
   Definition inner{"inner", "inner", {}, {}}, outer{"outer", "outer", {}, {}};
   for (const Index i : blob(*scene.lattice, 24, 5))
      inner.body.cells.set(i, {static_cast<MaterialIndex>(1 + floorMod(i.y, 2)), 0, 0});
   const auto innerId = scene.model.setDefinition(inner);
   for (int k = 0; k < 3; ++k)
      outer.body.instances.insert({*innerId, Index{2 * k * period[0], 0, 0}, 0});
   const auto outerId = scene.model.setDefinition(outer);
   for (int k = 0; k < 3; ++k)
      scene.model.root.instances.insert({*outerId, Index{0, 0, 2 * k * period[2]}, 0});
   scene.model.root.cells.set({-1, 0, 0}, {3, 0, 0});
   return scene;
}

inline std::string fault(const Geometry &geometry)
{
   for (const Solid &solid : geometry.solids)
      if (const auto what = manifoldFault(solid.mesh.triangles, solid.mesh.vertices.size()); !what.empty())
         return solid.name + ": " + what;
   return geometry.solids.empty() ? "no solid" : "";
}

inline double volume(const Geometry &geometry)
{
   double sum = 0;
   for (const Solid &solid : geometry.solids)
      sum += volumeOf(solid.mesh);
   return sum;
}

/// What is wrong with a file of this volume in its own units, by stl_check; empty when nothing is, or when it
/// cannot run. `closed`: no edges that only touch either.
inline std::string stlCheckFault(const std::filesystem::path &file, double volume, bool closed)
{
   if (sharedDir().empty())
      return {};
   const auto judge = run("python3", {QString::fromStdString((sharedDir() / "tools" / "stl_check").string()),
                                      "--no-shells", QString::fromStdString(file.string())});
   const auto verdict = nlohmann::json::parse(judge.out.toStdString(), nullptr, false);
   if (!verdict.is_object())
      return {};
   bool good = verdict[closed ? "closed" : "watertight"].get<bool>();
   for (const char *count : {"boundary_edges", "flipped_edges", "unbalanced_edges", "degenerate_triangles",
                             "wrong_normals", "zero_normals"})
      good = good && verdict[count].get<int>() == 0;
   good = good && std::abs(verdict["volume"].get<double>() / volume - 1) < 1e-4; // single precision
   return good ? "" : verdict.dump();
}

/// The same by admesh.
inline bool haveAdmesh()
{
   static const bool have = run("admesh", {"--help"}).exit == 0;
   return have;
}

inline std::string admeshFault(const std::filesystem::path &file, double volume)
{
   if (!haveAdmesh())
      return {};
   const auto judge = run("admesh", {QString::fromStdString(file.string())});
   const std::string text = judge.out.toStdString();
   const auto number = [&](const std::string &label) {
      const auto at = text.find(label);
      const auto colon = text.find(':', at);
      double value = -1e300;
      if (at != std::string::npos)
         std::istringstream(text.substr(colon + 1)) >> value;
      return value;
   };
   bool good = judge.exit == 0;
   for (const char *count :
        {"Total disconnected facets", "Degenerate facets", "Edges fixed", "Facets removed  ",
         "Facets added  ", "Facets reversed", "Backwards edges", "Normals fixed"})
      good = good && number(count) == 0;
   good = good && std::abs(number("Volume  ") / volume - 1) < 1e-3; // it adds up in single precision
   return good ? "" : text;
}

/// The same by prusa-slicer, by hand only: DIATOM_LONG_TESTS=1. It starts slowly.
inline std::string slicerFault(const std::filesystem::path &file, double volume)
{
   static const bool wanted = qEnvironmentVariableIsSet("DIATOM_LONG_TESTS");
   if (!wanted)
      return {};
   const auto judge = run("prusa-slicer", {"--info", QString::fromStdString(file.string())});
   const std::string text = judge.out.toStdString();
   const auto at = text.find("volume = ");
   double said = 0;
   if (at != std::string::npos)
      std::istringstream(text.substr(at + 9)) >> said;
   const bool good = text.find("manifold = yes") != std::string::npos && std::abs(said / volume - 1) < 1e-3;
   return good ? "" : "prusa-slicer: " + text + judge.err.toStdString();
}

} // namespace diatom::test
