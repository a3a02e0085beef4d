// The examples of docs/adding-a-plugin.md do what the page says.
#include "lattice/lattice.h"
#include "parts/decomposition.h"
#include "support/support.h"

#include <cmath>

using namespace diatom;

namespace {

std::shared_ptr<const Catalogue> examples()
{
   const auto built = test::binaryDir() / "tests" / "plugins";
   return Catalogue::find({built, test::binaryDir() / "plugins"});
}

} // namespace

class ExamplesTest : public QObject
{
   Q_OBJECT
private slots:
   void theLatticeFillsSpaceWithPrisms();
   void thePartsAreHalfCubes();
   void theMachineDescribesItself();
   void theSolverCountsBonds();
};

void ExamplesTest::theLatticeFillsSpaceWithPrisms()
{
   const Job job;
   LatticeSpec spec;
   spec.id = "org.example.lattice.tall_honeycomb";
   spec.pitch = 1;
   spec.values = {{"height", 2.0}};
   const auto lattice = Lattice::make(*examples(), spec, job);
   DIATOM_VERIFY_OK(lattice);
   int faces = 0;
   for (const Link &link : (*lattice)->links(0))
      faces += link.contact == Contact::face ? 1 : 0;
   QCOMPARE(faces, 8);
   // Prisms of area 3 sqrt3/2 and height 2 fill space; rounding of a few products.
   const double volume = 3 * std::sqrt(3.0);
   QVERIFY(std::abs((*lattice)->shape(0).volume - volume) < 1e-12);
   QVERIFY(std::abs((*lattice)->volumePerSite() - volume) < 1e-12);
}

void ExamplesTest::thePartsAreHalfCubes()
{
   const Job job;
   const auto maker =
       PartMaker::make(*examples(), "org.example.parts.slabs", {}, "org.diatom_cad.lattice.cube", job);
   DIATOM_VERIFY_OK(maker);
   QCOMPARE((*maker)->types().front().share, 2);
   const auto mesh = (*maker)->mesh(0, 1, 0, 1e-3, job);
   DIATOM_VERIFY_OK(mesh);
   QCOMPARE(mesh->triangles.size(), std::size_t{12});
}

void ExamplesTest::theMachineDescribesItself()
{
   const Job job;
   const auto machine =
       examples()->create<diatom_machine>(DIATOM_MACHINE_1, "org.example.machine.by_hand", {}, job);
   DIATOM_VERIFY_OK(machine);
   const diatom_machine_description *description = nullptr;
   DIATOM_VERIFY_OK((*machine)->call("describe", job, [&](const diatom_call *call) {
      return (*machine)->table<diatom_machine>()->describe((*machine)->self(), call, &description);
   }));
   QCOMPARE(description->axes, 3);
   QCOMPARE(std::string(description->suffix), std::string("txt"));
}

void ExamplesTest::theSolverCountsBonds()
{
   const Job job;
   // A chain of four cells, the first one held: distances 0 1 2 3.
   const std::int32_t a[] = {0, 1, 2}, b[] = {1, 2, 3};
   const std::int64_t held[] = {0};
   const double mask[] = {63};
   const diatom_channel fixed{"fixed", 1, 1, held, mask};
   diatom_scene scene{};
   scene.size = sizeof scene;
   scene.cells = 4;
   scene.links = 3;
   scene.link_a = a;
   scene.link_b = b;
   scene.channels = 1;
   scene.channel = &fixed;
   const auto solver = examples()->createWith(
       DIATOM_SOLVER_1, "org.example.solver.distance", {}, job,
       [&](const void *table, const diatom_call *call, const diatom_create *create, void **self) {
          return static_cast<const diatom_solver *>(table)->create(call, create, &scene, self);
       },
       [](const void *table) { return static_cast<const diatom_solver *>(table)->destroy; });
   DIATOM_VERIFY_OK(solver);
   const diatom_step_request request{sizeof request, 0, 0, 100, 0};
   diatom_step_result result{};
   result.size = sizeof result;
   double distance[4] = {};
   DIATOM_VERIFY_OK((*solver)->call("step", job, [&](const diatom_call *call) {
      const auto *table = (*solver)->table<diatom_solver>();
      const std::int32_t status = table->step((*solver)->self(), call, &request, &result);
      return status == DIATOM_OK ? table->read((*solver)->self(), call, 0, 0, 4, distance) : status;
   }));
   QCOMPARE(result.state, std::int64_t{DIATOM_CONVERGED});
   for (int i = 0; i < 4; ++i)
      QCOMPARE(distance[i], double(i));
}

QTEST_APPLESS_MAIN(ExamplesTest)
#include "examples_test.moc"
