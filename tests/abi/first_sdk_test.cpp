// Plugins built with the first SDK work with today's host, whichever compiler built either; so do one built
// with the headers of a later minor, one linked with -ffast-math and one with a C++ runtime of its own.
#include "assembly/plan.h"
#include "plugins/warnings.h"
#include "scene/simulation.h"
#include "support/scenes.h"

#include <array>
#include <cmath>
#include <limits>

using namespace diatom;
namespace fs = std::filesystem;

namespace {

std::shared_ptr<const Catalogue> samplesOf(const QString &variant)
{
   return Catalogue::find(
       {test::binaryDir() / "tests/sdk-1.0" / variant.toStdString(), test::binaryDir() / "plugins"});
}

bool has(const Catalogue &catalogue, const char *interface, const char *id)
{
   return catalogue.offer(interface, id) != nullptr;
}

/// Two towers on each other and one beside, on the lattice of the sample.
struct Towers
{
   std::shared_ptr<const Lattice> lattice;
   Model model;

   explicit Towers(const Catalogue &catalogue)
   {
      model.lattice.id = "org.example.sample.lattice";
      model.lattice.pitch = 1e-2;
      auto made = Lattice::make(catalogue, model.lattice, Job());
      if (!made)
         qFatal("%s", made.error().message.c_str());
      lattice = *std::move(made);
      Material clay;
      clay.id = clay.name = "clay";
      if (!model.setMaterial(clay).ok())
         qFatal("no clay");
      for (const Index cell : {Index{0, 0, 0}, Index{0, 0, 1}, Index{1, 0, 0}})
         model.root.cells.set(cell, Cell{1, 0, 0});
   }
   Hierarchy hierarchy() const { return Hierarchy(lattice, model); }
};

} // namespace

class FirstSdkTest : public QObject
{
   Q_OBJECT
private slots:
   void fastMathStaysInThePlugin(); // first: a library is loaded once in a process
   void theLatticeHasItsNeighbours_data() { variants(); }
   void theLatticeHasItsNeighbours();
   void thePartsAreMade_data() { variants(); }
   void thePartsAreMade();
   void theMachinePosts_data() { variants(); }
   void theMachinePosts();
   void theSolverSteps_data() { variants(); }
   void theSolverSteps();

private:
   static void variants()
   {
      QTest::addColumn<QString>("variant");
      for (const QString &name : QStringLiteral(DIATOM_ABI_VARIANTS).split(','))
         QTest::newRow(qPrintable(name)) << name;
   }
   /// Variants that differ in linking alone have no sample of every kind.
   static bool partial(const QString &variant)
   {
      return variant == "fast_math" || variant == "static_runtime";
   }
};

void FirstSdkTest::theLatticeHasItsNeighbours()
{
   QFETCH(QString, variant);
   const Towers towers(*samplesOf(variant));
   const Lattice &lattice = *towers.lattice;
   // A box in a grid of boxes touches 6 by faces, 12 by edges and 8 by corners, and is joined by its faces.
   std::array<int, 3> touching{};
   int joined = 0;
   for (const Link &link : lattice.links(0)) {
      ++touching[static_cast<std::size_t>(link.contact)];
      joined += link.joined ? 1 : 0;
   }
   QCOMPARE(touching, (std::array<int, 3>{6, 12, 8}));
   QCOMPARE(joined, 6);
   // Twice as high as wide: 2 times the pitch's cube; rounding of a few products.
   QVERIFY(std::abs(lattice.shape(0).volume - 2e-6) < 1e-18);
   QVERIFY((lattice.position({1, 2, 3}) - Vec3(1e-2, 2e-2, 6e-2)).norm() < 1e-15);
}

void FirstSdkTest::thePartsAreMade()
{
   QFETCH(QString, variant);
   const auto catalogue = samplesOf(variant);
   QCOMPARE(has(*catalogue, DIATOM_PARTS_1, "org.example.sample.parts"), !partial(variant));
   if (partial(variant))
      return;
   const Towers towers(*catalogue);
   const auto maker = PartMaker::make(*catalogue, "org.example.sample.parts", {{"shrink", 0.2}},
                                      "org.example.sample.lattice", Job());
   DIATOM_VERIFY_OK(maker);
   const auto made = (*maker)->decompose(towers.hierarchy(), Job());
   DIATOM_VERIFY_OK(made);
   QCOMPARE(made->parts.size(), std::size_t{3});
   QCOMPARE(made->covered, (std::vector<Index>{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}));
   const auto mesh = (*maker)->mesh(0, 1, 0, 1e-2, Job());
   DIATOM_VERIFY_OK(mesh);
   QVERIFY(std::abs(mesh->vertices.front().x() + 4e-3) < 1e-15); // half of 0.8 of the pitch
}

void FirstSdkTest::theMachinePosts()
{
   QFETCH(QString, variant);
   const auto catalogue = samplesOf(variant);
   QCOMPARE(has(*catalogue, DIATOM_MACHINE_1, "org.example.sample.machine"), !partial(variant));
   if (partial(variant))
      return;
   const Towers towers(*catalogue);
   const Hierarchy hierarchy = towers.hierarchy();
   const auto maker =
       PartMaker::make(*catalogue, "org.example.sample.parts", {}, "org.example.sample.lattice", Job());
   DIATOM_VERIFY_OK(maker);
   const auto parts = (*maker)->decompose(hierarchy, Job());
   DIATOM_VERIFY_OK(parts);
   const auto plan = planAssembly(hierarchy, *parts, Job());
   DIATOM_VERIFY_OK(plan);
   const auto machine = Machine::make(*catalogue, "org.example.sample.machine", {}, Job());
   DIATOM_VERIFY_OK(machine);
   QCOMPARE(std::string((*machine)->description().suffix), std::string("places"));
   std::string text;
   const auto summary = (*machine)->write(
       hierarchy, *parts, *plan, "towers", [&](std::string_view piece) { text += piece; }, Job());
   DIATOM_VERIFY_OK(summary);
   QCOMPARE(summary->placements, std::int64_t{3});
   // The lower layer before the one that stands on it.
   QCOMPARE(text, std::string("0 0 0\n1 0 0\n0 0 1\n"));
}

void FirstSdkTest::theSolverSteps()
{
   QFETCH(QString, variant);
   const auto catalogue = samplesOf(variant);
   const Towers towers(*catalogue);
   Setup setup;
   setup.gravity = {0, 0, -9.81};
   setup.solver = "org.example.sample.solver";
   auto scene = Scene::build(towers.hierarchy(), setup, Job());
   DIATOM_VERIFY_OK(scene);
   const auto run = Simulation::start(catalogue, *std::move(scene), setup, {}, Job());
   DIATOM_VERIFY_OK(run);
   DIATOM_VERIFY_OK((*run)->advance(0.1, Job()));
   QCOMPARE((*run)->steps(), std::int64_t{100});
   const auto fallen = (*run)->probe(1, "z", Job());
   DIATOM_VERIFY_OK(fallen);
   QVERIFY(std::abs(*fallen + 9.81 * 0.01 / 2) < 1e-15); // g t^2 / 2, and the rounding of one sum
}

/// Its library sets flush-to-zero for the thread that loads it; the host puts the mode back and says who it
/// was.
void FirstSdkTest::fastMathStaysInThePlugin()
{
   const auto catalogue = samplesOf("fast_math");
   std::string warned;
   setPluginWarnings([&](const std::string &text, PluginWarning) { warned += text; });
   const Towers towers(*catalogue);
   setPluginWarnings({});
   volatile double smallest = std::numeric_limits<double>::denorm_min();
   QVERIFY(smallest * 3 > 0); // with flush-to-zero this product is 0
   QVERIFY2(warned.find("org.example.sample.lattice changed the floating-point mode while it was loaded") !=
                std::string::npos,
            warned.c_str());
}

QTEST_APPLESS_MAIN(FirstSdkTest)
#include "first_sdk_test.moc"
