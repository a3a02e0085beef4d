// Solvers in a process of their own: the same bits as in this one, and faults that cost a message.
#include "cli/program.h"
#include "core/sanitizers.h"
#include "plugins/shared_memory.h"
#include "scene/simulation.h"
#include "support/scenes.h"

using namespace diatom;
namespace fs = std::filesystem;

namespace {

QByteArray textOf(const QString &path)
{
   QFile file(path);
   return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

/// Two free cubes and a false solver that does `fault` in its step.
struct FalseRun
{
   std::shared_ptr<const Catalogue> catalogue = Catalogue::find(
       {test::binaryDir() / "tests/plugins", test::binaryDir() / "plugins"}, false, Isolate::all);
   test::Scene scene{"org.diatom_cad.lattice.cube"};

   Result<std::unique_ptr<Simulation>> start(const char *fault, const Job &job) const
   {
      const Hierarchy hierarchy = scene.hierarchy();
      Setup setup;
      setup.solver = "test.false.solver";
      auto built = Scene::build(hierarchy, setup, job);
      if (!built)
         return built.error();
      return Simulation::start(catalogue, *std::move(built), setup, {{"fault", fault}}, job);
   }
   std::string advance(const char *fault, const Job &job) const
   {
      auto run = start(fault, job);
      if (!run)
         return run.error().message;
      const Status status = (*run)->advance(1e-2, job);
      return status ? "" : status.error().message;
   }
   FalseRun()
   {
      scene.model.root.cells.set({0, 0, 0}, Cell{1, 0, 0});
      scene.model.root.cells.set({1, 0, 0}, Cell{1, 0, 0});
   }
};

} // namespace

class IsolationTest : public QObject
{
   Q_OBJECT
private slots:
   void initTestCase()
   {
      qputenv("XDG_CACHE_HOME", (m_dir.path() + "/cache").toUtf8()); // verdicts on libraries
   }

   void memoryAndDescriptorsGoAcross()
   {
      auto ends = Line::make();
      DIATOM_VERIFY_OK(ends);
      auto sent = SharedMemory::make(10'000);
      DIATOM_VERIFY_OK(sent);
      sent->data()[9'999] = std::byte{42};
      QVERIFY(ends->first.send("here", sent->descriptor()));
      std::string message;
      Descriptor descriptor;
      QVERIFY(ends->second.receive(message, descriptor, 1000) == Line::Got::message);
      QCOMPARE(message, std::string("here"));
      auto got = SharedMemory::map(std::move(descriptor), 10'000);
      DIATOM_VERIFY_OK(got);
      QVERIFY(got->data()[9'999] == std::byte{42});
      got->data()[0] = std::byte{7};
      QVERIFY(sent->data()[0] == std::byte{7}); // one memory, two places
      QVERIFY(ends->second.receive(message, descriptor, 0) == Line::Got::nothing);
      QVERIFY(ends->first.send("more than was said", sent->descriptor()));
      QVERIFY(ends->second.receive(message, descriptor, 1000) == Line::Got::message);
      QVERIFY(!SharedMemory::map(std::move(descriptor), 1'000'000).ok());
      ends->first.close();
      QVERIFY(ends->second.receive(message, descriptor, 1000) == Line::Got::closed);
      QVERIFY(!ends->second.send("to nobody"));
   }

   /// The solver is the same library and gets the same bytes: nothing may differ.
   void bothGiveTheSameBits_data()
   {
      QTest::addColumn<QStringList>("arguments");
      const auto sample = [](const char *name) {
         return QString::fromStdString((test::samplesDir() / name).string());
      };
      QTest::newRow("motion") << QStringList{
          "simulate", sample("bending-beam.diatom"), "--until", "0.01", "--record", "OUT"};
      QTest::newRow("actuated motion on two threads") << QStringList{
          "simulate", sample("gripper.diatom"), "--until", "0.01", "--threads", "2", "--record", "OUT"};
      QTest::newRow("balance") << QStringList{"solve", sample("bending-beam.diatom"), "--state", "OUT"};
      QTest::newRow("balance with a warning")
          << QStringList{"solve", sample("bending-beam.diatom"), "--effects=-rotation", "--state", "OUT"};
      QTest::newRow("modes") << QStringList{"modes", sample("bending-beam.diatom"), "--shapes", "OUT"};
   }
   void bothGiveTheSameBits()
   {
      QFETCH(QStringList, arguments);
      QByteArray files[2], warnings[2];
      for (int isolated = 0; isolated < 2; ++isolated) {
         const QString out = m_dir.filePath(QString("out%1.csv").arg(isolated));
         QStringList all = arguments;
         all.replaceInStrings("OUT", out);
         if (isolated)
            all.prepend("--isolate");
         const auto ran = test::diatomRuns(all);
         QVERIFY2(ran.exit == 0, ran.err.constData());
         files[isolated] = textOf(out);
         const auto at = ran.err.indexOf("org.diatom_cad.solver.bonds: ");
         warnings[isolated] = at < 0 ? QByteArray() : ran.err.mid(at);
      }
      QVERIFY(files[0].size() > 100);
      QVERIFY(files[0] == files[1]);
      QCOMPARE(warnings[0], warnings[1]);
      QCOMPARE(warnings[0].contains("rotation is switched off"), arguments.contains("--effects=-rotation"));
   }

   void aSoundSolverRuns() { QCOMPARE(FalseRun().advance("", Job()), std::string()); }

   void aCrashCostsAMessage()
   {
      const FalseRun run;
      const std::string said = run.advance("crash", Job());
      // Sanitizers catch the signal, report and end the process themselves.
      const std::string how =
          kAddressSanitizer || kThreadSanitizer ? "its process ended" : "its process ended in a crash";
      QVERIFY2(said.find("test.false.solver (step): " + how) == 0, said.c_str());
      QVERIFY2(said.find("the design is as it was") != std::string::npos, said.c_str());
      QCOMPARE(run.advance("", Job()), std::string()); // the next one has a process of its own
      const std::string left = run.advance("leave", Job());
      QVERIFY2(left.find("its process ended before it was done") != std::string::npos, left.c_str());
   }

   void exceptionsAndFalseAnswersAreToldAsInThisProcess()
   {
      const FalseRun run;
      QCOMPARE(run.advance("throws", Job()), std::string("test.false.solver (step): the wheel came off"));
      const std::string state = run.advance("state", Job());
      QVERIFY2(state.find("in a state 99 that does not exist") != std::string::npos, state.c_str());
      const std::string rows = run.advance("limits", Job());
      QVERIFY2(!rows.empty(), "it was taken");
   }

   void memoryIsLimitedByTheEstimate()
   {
      if (!kMayLimitMemory)
         QSKIP("sanitizers reserve more address space than any limit");
      const std::string said = FalseRun().advance("memory", Job());
      QVERIFY2(said.find("memory") != std::string::npos, said.c_str());
   }

   void whoLeaksMeetsTheSameLimit()
   {
      if (!kMayLimitMemory)
         QSKIP("sanitizers reserve more address space than any limit");
      const FalseRun run;
      auto leaking = run.start("leaks", Job());
      DIATOM_VERIFY_OK(leaking);
      std::string said;
      for (int step = 1; step <= 100 && said.empty(); ++step) // 3.2 GiB, ten times what it may take
         if (const Status status = (*leaking)->advance(1e-2 * step, Job()); !status)
            said = status.error().message;
      QVERIFY2(said.find("memory") != std::string::npos, said.c_str());
   }

   void whoIgnoresCancelIsEnded()
   {
      const FalseRun run;
      Job *hanging = nullptr;
      Job job([&](double fraction, std::string_view) {
         if (fraction == 0.5) // what the solver tells before it hangs
            hanging->cancel();
      });
      hanging = &job;
      const std::string said = run.advance("hang", job);
      QVERIFY2(said.find("did not stop within 10 s of being cancelled") != std::string::npos, said.c_str());
   }

   void theWorkerDoesNothingByItself()
   {
      const auto ran =
          test::run(QString::fromStdString((test::binaryDir() / "bin/diatom-worker").string()), {});
      QCOMPARE(ran.exit, 2);
      QVERIFY(ran.err.contains("does nothing by itself"));
   }

private:
   QTemporaryDir m_dir;
};

QTEST_GUILESS_MAIN(IsolationTest)
#include "isolation_test.moc"
