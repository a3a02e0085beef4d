// CalculiX beside the shipped solver, where it is installed: the shear flexure of thesis figure 7-4 and the
// bimorph of figure 7-5, in accuracy, degrees of freedom and seconds. Times are told, never judged.
#include "support/process.h"
#include "support/support.h"
#include "verify/forms.h"

#include <QFile>
#include <QRegularExpression>
#include <QTest>

#include <chrono>
#include <cmath>
#include <memory>

using namespace diatom;

namespace {

struct Peer
{
   double uy = 0, seconds = 0;
   int freedoms = 0; // three for each node, held ones and those that beams are expanded to included
};

double secondsSince(std::chrono::steady_clock::time_point start)
{
   return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Mean of the last table of displacements that CalculiX printed.
std::optional<double> lastMeanUy(const QByteArray &printed)
{
   double sum = 0;
   int rows = 0;
   bool table = false;
   for (const QByteArray &line : printed.split('\n')) {
      const auto words = QString::fromUtf8(line).simplified().split(' ', Qt::SkipEmptyParts);
      const bool row = words.size() == 4 && words[0].toInt() > 0;
      if (row && !table)
         sum = rows = 0;
      table = row || (table && words.isEmpty());
      if (row) {
         sum += words[2].toDouble();
         ++rows;
      }
   }
   return rows > 0 ? std::optional(sum / rows) : std::nullopt;
}

int nodesOf(const QByteArray &deck)
{
   int nodes = 0;
   bool inside = false;
   for (const QByteArray &line : deck.split('\n')) {
      if (line.startsWith('*'))
         inside = line.startsWith("*NODE,") || line.trimmed() == "*NODE";
      else if (inside && !line.trimmed().isEmpty())
         ++nodes;
   }
   return nodes;
}

Peer runCalculix(const QString &deck)
{
   QFile file(
       QString::fromStdString((test::sharedDir() / "validation" / "decks" / deck.toStdString()).string()));
   const QTemporaryDir folder;
   if (!file.open(QIODevice::ReadOnly))
      qFatal("no deck %s", qPrintable(deck));
   const QByteArray text = file.readAll();
   const QString job = folder.filePath("job");
   QFile copy(job + ".inp");
   if (!copy.open(QIODevice::WriteOnly) || copy.write(text) != text.size())
      qFatal("cannot write %s", qPrintable(job));
   copy.close();
   const auto start = std::chrono::steady_clock::now();
   const auto outcome = test::run("ccx", {"-i", job});
   Peer peer{0, secondsSince(start), 3 * nodesOf(text)};
   QFile printed(job + ".dat");
   const auto uy = printed.open(QIODevice::ReadOnly) ? lastMeanUy(printed.readAll()) : std::nullopt;
   if (outcome.exit != 0 || !uy)
      qFatal("ccx failed on %s: %s", qPrintable(deck), outcome.out.right(500).constData());
   peer.uy = *uy;
   return peer;
}

Case caseOf(const char *name)
{
   auto one = readCase(test::sharedDir() / "validation" / (std::string(name) + ".json"));
   if (!one)
      qFatal("%s", one.error().message.c_str());
   return *std::move(one);
}

/// Balance of a scene, the best of three times.
Peer runOurs(const CaseScene &scene, Index at, const std::vector<Index> &also, int free)
{
   const Job job;
   const Bench bench{test::catalogue(), &job};
   Peer ours{0, HUGE_VAL, free};
   for (int i = 0; i < 3; ++i) {
      const auto start = std::chrono::steady_clock::now();
      const auto answer = balanceOf(bench, scene, modelValues("b_exact"));
      ours.seconds = std::min(ours.seconds, secondsSince(start));
      if (!answer)
         qFatal("%s", answer.error().message.c_str());
      ours.uy = answer->displacement(at).y();
      for (const Index &other : also)
         ours.uy += answer->displacement(other).y();
   }
   ours.uy /= static_cast<double>(1 + also.size());
   return ours;
}

void tell(const char *what, const Peer &peer, const Peer &ours)
{
   qInfo("| %s | %.4g um | %d | %.3f | %+.2f %% | %.0f |", what, 1e6 * peer.uy, peer.freedoms, peer.seconds,
         100 * (ours.uy / peer.uy - 1), peer.seconds / ours.seconds);
}

} // namespace

class VerifyCalculixTest : public QObject
{
   Q_OBJECT

private slots:
   void initTestCase();
   void shearFlexure_data();
   void shearFlexure();
   void bimorph();
};

void VerifyCalculixTest::initTestCase()
{
   if (test::sharedDir().empty())
      QSKIP("the reference data (../shared) is not beside the project");
   if (test::run("ccx", {"-v"}).exit < 0)
      QSKIP("CalculiX (package calculix-ccx) is not installed");
}

void VerifyCalculixTest::shearFlexure_data()
{
   QTest::addColumn<int>("row");
   QTest::addColumn<QString>("load");
   for (const char *kind : {"single", "double"}) {
      QTest::newRow((std::string(kind) + " linear").c_str()) << 0 << "lin0.0012";
      QTest::newRow((std::string(kind) + " far").c_str()) << 1 << "nl0.012";
   }
}

/// "b_exact_vs_ccx_nu0_rel" of the case, 2.5 %, against the same bars without sideways contraction; with it a
/// blade as wide as long is stiffer than a beam by up to 13 % (its "What to know" 4), which is more than
/// beams can know.
void VerifyCalculixTest::shearFlexure()
{
   QFETCH(int, row);
   QFETCH(QString, load);
   const QString kind = QString::fromUtf8(QTest::currentDataTag()).section(' ', 0, 0);
   const Case one = caseOf(("c09-shear-flexure-" + kind.toStdString()).c_str());
   CaseScene scene = flexureScene(one);
   const Index at = indexOf(one.content.at("load_cell"));
   const auto &asked = one.content.at("results").at(static_cast<std::size_t>(row));
   scene.load(at, asked.at("F").get<double>() * Vec3::Unit(1));
   const int free =
       6 * (one.content.at("n_cells").get<int>() - static_cast<int>(scene.setup().supports.size()));
   const Peer ours = runOurs(scene, at, {}, free);
   qInfo("| %s: Diatom, b_exact | %.4g um | %d | %.3f | | |", QTest::currentDataTag(), 1e6 * ours.uy, free,
         ours.seconds);
   for (const char *element : {"B32R", "C3D20R"})
      for (const char *nu : {"nu0", "nu0.3"}) {
         const QString deck = QString("c09-shear-flexure-%1-%2-%3-%4.inp").arg(kind, element, nu, load);
         const Peer peer = runCalculix(deck);
         tell(qPrintable(QString("CalculiX %1 %2").arg(element, nu)), peer, ours);
         const double bar = nu == std::string("nu0")
                                ? one.content.at("tol").at("b_exact_vs_ccx_nu0_rel").get<double>()
                                : 0.16;
         QVERIFY2(std::abs(ours.uy / peer.uy - 1) < bar, qPrintable(deck));
      }
}

/// "ccx (linear row)": 1 %. Without and with sideways contraction alike, since nothing holds the sides.
void VerifyCalculixTest::bimorph()
{
   const Case one = caseOf("c09-bimorph");
   const int last = one.content.at("cells").at(0).at("box").at(1).at(0);
   const Peer ours = runOurs(bimorphScene(one, 1e-6), {last, 0, 0}, {{last, 1, 0}}, 12 * last);
   qInfo("| bimorph: Diatom, b_exact | %.4g um | %d | %.3f | | |", 1e6 * ours.uy, 12 * last, ours.seconds);
   for (const char *nu : {"nu0", "nu0.3"}) {
      const Peer peer = runCalculix(QString("c09-bimorph-%1-lin.inp").arg(nu));
      tell(qPrintable(QString("CalculiX C3D20R %1").arg(nu)), peer, ours);
      QVERIFY(std::abs(ours.uy / peer.uy - 1) < 0.01);
   }
}

QTEST_APPLESS_MAIN(VerifyCalculixTest)
#include "verify_calculix_test.moc"
