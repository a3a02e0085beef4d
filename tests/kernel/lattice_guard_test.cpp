// Motifs that a faulty plugin might hand over: each is refused, by its own sentence and never by a crash.
#include "lattice/lattice_builder.h"
#include "support/support.h"

#include <cmath>
#include <functional>
#include <limits>

using namespace diatom;

namespace {

/// A cube lattice with two sites along z, written out by hand, joined through faces.
struct HandMade
{
   std::vector<double> basis{1, 0, 0, 0, 1, 0, 0, 0, 1};
   std::vector<double> offset{0, 0, 0, 0, 0, 0};
   std::vector<double> orientation{1, 0, 0, 0, 1, 0, 0, 0};
   std::vector<std::int32_t> shape{0, 0};
   std::vector<std::int32_t> vertexStart{0, 8}, shapeFaceStart{0, 6}, faceStart{0, 4, 8, 12, 16, 20, 24};
   std::vector<double> vertices;
   std::vector<std::int32_t> faceVertices{0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1,
                                          2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3};
   std::vector<std::int32_t> rotationStart{0, 2};
   std::vector<double> rotations{1, 0, 0, 0, 0, 0, 0, 1};
   std::vector<std::int32_t> linkStart{0, 6, 12};
   std::vector<std::int32_t> linkOffset{-1, 0, 0, 1, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, -1, 0, 0, 1};
   std::vector<std::int32_t> linkContact = std::vector<std::int32_t>(12, DIATOM_CONTACT_FACE);
   std::vector<std::int32_t> linkFeature{0, 1, 2, 3, 4, 5, 0, 1, 2, 3, 4, 5};
   std::vector<std::int32_t> linkJoined = std::vector<std::int32_t>(12, 1);
   std::vector<std::int32_t> supercellStep{1, 0, 0, 1, 0, 0};
   diatom_motif record{};

   HandMade()
   {
      // Corner number: bits x, y, z from high to low. Faces above: -x, +x, -y, +y, -z, +z, as the links are
      // ordered.
      for (int v = 0; v < 8; ++v)
         vertices.insert(vertices.end(), {v & 4 ? 0.5 : -0.5, v & 2 ? 0.5 : -0.5, v & 1 ? 0.5 : -0.5});
      linkOffset.insert(linkOffset.end(), linkOffset.begin(), linkOffset.begin() + 18);
      record.size = sizeof record;
      record.period[0] = record.period[1] = 1;
      record.period[2] = 2;
      record.sites = 2;
      record.shapes = 1;
      record.supercell_default = 2;
   }
   HandMade(const HandMade &) = delete;
   HandMade &operator=(const HandMade &) = delete;

   /// Points the record at the arrays, which may have been exchanged.
   Result<std::shared_ptr<const Lattice>> build()
   {
      record.basis = basis.data();
      record.offset = offset.data();
      record.orientation = orientation.data();
      record.shape = shape.data();
      record.shape_vertex_start = vertexStart.data();
      record.vertices = vertices.data();
      record.shape_face_start = shapeFaceStart.data();
      record.face_start = faceStart.data();
      record.face_vertices = faceVertices.data();
      record.rotation_start = rotationStart.data();
      record.rotations = rotations.data();
      record.link_start = linkStart.data();
      record.link_offset = linkOffset.data();
      record.link_contact = linkContact.data();
      record.link_feature = linkFeature.data();
      record.link_joined = linkJoined.data();
      record.supercell_step = supercellStep.data();
      if (withdraw)
         withdraw(record);
      LatticeSpec spec;
      spec.id = "org.example.broken";
      return LatticeBuilder::fromMotif(spec, record);
   }
   std::function<void(diatom_motif &)> withdraw; // last change to the record itself
};

using Break = std::function<void(HandMade &)>;
struct Case
{
   const char *name;
   const char *sentence; // part of the message
   Break breakIt;
};

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Case> brokenNumbers()
{
   return {
       {"basis NaN", "basis", [](HandMade &m) { m.basis[4] = kNan; }},
       {"basis infinite", "basis", [](HandMade &m) { m.basis[4] = kInfinity; }},
       {"basis flat", "plane", [](HandMade &m) { m.basis[8] = 0; }},
       {"offset NaN", "offset of site 1", [](HandMade &m) { m.offset[5] = kNan; }},
       {"corner infinite", "corner of shape 0", [](HandMade &m) { m.vertices[7] = -kInfinity; }},
       {"orientation not unit", "orientation of site 1", [](HandMade &m) { m.orientation[4] = 0.9; }},
       {"orientation NaN", "orientation of site 0", [](HandMade &m) { m.orientation[0] = kNan; }},
       {"rotation not unit", "rotation 1 of shape 0 is not a unit", [](HandMade &m) { m.rotations[7] = 2; }},
       {"rotation not its own", "onto itself",
        [](HandMade &m) { m.rotations = {1, 0, 0, 0, std::sqrt(0.5), 0.5, 0.5, 0}; }},
       {"rotation twice", "twice", [](HandMade &m) { m.rotations[4] = -1, m.rotations[7] = 0; }},
       {"identity not first", "identity", [](HandMade &m) { m.rotations = {0, 0, 0, 1, 1, 0, 0, 0}; }},
       {"rotations no group", "product of two",
        [](HandMade &m) { m.rotations = {1, 0, 0, 0, std::sqrt(0.5), 0, 0, std::sqrt(0.5)}; }},
   };
}

std::vector<Case> brokenCounts()
{
   return {
       {"record too short", "bytes", [](HandMade &m) { m.record.size = 8; }},
       {"period zero", "period", [](HandMade &m) { m.record.period[1] = 0; }},
       {"period negative", "period", [](HandMade &m) { m.record.period[1] = -2147483647 - 1; }},
       {"period huge", "period", [](HandMade &m) { m.record.period[1] = 2147483647; }},
       {"sites not the product", "sites", [](HandMade &m) { m.record.sites = 1; }},
       {"no shapes", "shapes", [](HandMade &m) { m.record.shapes = 0; }},
       {"array missing", "missing",
        [](HandMade &m) { m.withdraw = [](auto &r) { r.link_feature = nullptr; }; }},
       {"shape out of range", "site 1 has shape 7", [](HandMade &m) { m.shape[1] = 7; }},
       {"vertex count falls", "fewer than 4", [](HandMade &m) { m.vertexStart[1] = 0; }},
       {"vertex count negative", "counts of shape 0", [](HandMade &m) { m.vertexStart[1] = -5; }},
       {"vertex count huge", "counts of shape 0", [](HandMade &m) { m.vertexStart[1] = 2000000000; }},
       {"start not zero", "begin with 0", [](HandMade &m) { m.faceStart[0] = 1; }},
       {"face counts fall", "counts of shape 0", [](HandMade &m) { m.faceStart[3] = 2; }},
       {"no rotations", "not even the identity", [](HandMade &m) { m.rotationStart[1] = 0; }},
       {"link counts fall", "counts of its links", [](HandMade &m) { m.linkStart[1] = -1; }},
       {"link counts huge", "counts of its links", [](HandMade &m) { m.linkStart[2] = 1000000000; }},
   };
}

std::vector<Case> brokenShapes()
{
   return {
       {"corner out of range", "not there", [](HandMade &m) { m.faceVertices[5] = 8; }},
       {"corner negative", "not there", [](HandMade &m) { m.faceVertices[5] = -1; }},
       {"corner twice", "one twice", [](HandMade &m) { m.faceVertices[1] = 0; }},
       {"open", "not closed", [](HandMade &m) { m.shapeFaceStart[1] = 5; }},
       {"one face inside out", "one direction",
        [](HandMade &m) { std::swap(m.faceVertices[1], m.faceVertices[3]); }},
       {"all faces inside out", "clockwise",
        [](HandMade &m) {
           for (std::size_t f = 0; f < 24; f += 4)
              std::swap(m.faceVertices[f + 1], m.faceVertices[f + 3]);
        }},
       {"dented", "not convex", [](HandMade &m) { m.vertices[0] = m.vertices[1] = m.vertices[2] = 0.3; }},
       {"centre outside", "about its centre",
        [](HandMade &m) {
           for (std::size_t v = 0; v < 24; v += 3)
              m.vertices[v] += 0.75;
        }},
       {"no volume", "shape 0",
        [](HandMade &m) {
           for (std::size_t v = 2; v < 24; v += 3)
              m.vertices[v] = 0;
        }},
       {"unused corner", "uses every corner",
        [](HandMade &m) {
           m.vertices.insert(m.vertices.end(), {0, 0, 0});
           m.vertexStart[1] = 9;
        }},
   };
}

std::vector<Case> brokenLinks()
{
   return {
       {"to itself", "itself", [](HandMade &m) { m.linkOffset[0] = 0; }},
       {"far", "steps far", [](HandMade &m) { m.linkOffset[0] = 2147483647; }},
       {"twice", "where another does", [](HandMade &m) { m.linkOffset[3] = -1; }},
       {"unknown contact", "contact 3", [](HandMade &m) { m.linkContact[2] = 3; }},
       {"feature out of range", "feature 6 of 6", [](HandMade &m) { m.linkFeature[2] = 6; }},
       {"joined is no flag", "joined 2", [](HandMade &m) { m.linkJoined[2] = 2; }},
       {"one way", "not mutual", [](HandMade &m) { m.linkOffset[17] = 3; }},
       {"joined one way", "not mutual", [](HandMade &m) { m.linkJoined[0] = 0; }},
       {"contact one way", "not mutual", [](HandMade &m) { m.linkContact[0] = DIATOM_CONTACT_EDGE; }},
       {"features apart", "do not meet", [](HandMade &m) { std::swap(m.linkFeature[0], m.linkFeature[1]); }},
       {"sites overlap", "overlap",
        [](HandMade &m) {
           m.basis[8] = 4; // room enough for both, but the second is put into the first
           m.offset[5] = -3.5;
           m.linkStart = {0, 0, 0};
        }},
       {"more than space", "overlap",
        [](HandMade &m) {
           m.basis[0] = 0.9;
           m.linkStart = {0, 0, 0};
        }},
       {"brick of no length", "brick step of site 1", [](HandMade &m) { m.supercellStep[3] = 0; }},
       {"brick across sites", "another step", [](HandMade &m) { m.supercellStep = {0, 0, 1, 0, 0, 2}; }},
       {"brick lengths", "longest", [](HandMade &m) { m.record.supercell_longest = 1; }},
   };
}

void addCases(const std::vector<Case> &cases)
{
   QTest::addColumn<Case>("broken");
   for (const Case &c : cases)
      QTest::newRow(c.name) << c;
}

void expectRefusal(const Case &broken)
{
   HandMade motif;
   broken.breakIt(motif);
   const auto made = motif.build();
   QVERIFY(!made.ok());
   const std::string &message = made.error().message;
   QVERIFY2(message.find("org.example.broken") != std::string::npos, message.c_str());
   QVERIFY2(message.find(broken.sentence) != std::string::npos, message.c_str());
}

} // namespace

Q_DECLARE_METATYPE(Case)

class LatticeGuardTest : public QObject
{
   Q_OBJECT

private slots:
   void aSoundMotifIsAccepted();
   void brokenNumbersAreRefused_data() { addCases(brokenNumbers()); }
   void brokenNumbersAreRefused() { check(); }
   void brokenCountsAreRefused_data() { addCases(brokenCounts()); }
   void brokenCountsAreRefused() { check(); }
   void brokenShapesAreRefused_data() { addCases(brokenShapes()); }
   void brokenShapesAreRefused() { check(); }
   void brokenLinksAreRefused_data() { addCases(brokenLinks()); }
   void brokenLinksAreRefused() { check(); }
   void anObliqueBasisStillFindsTheNearestCell();
   void aLatticeThatIsNotInstalledIsNamed();

private:
   static void check()
   {
      QFETCH(Case, broken);
      expectRefusal(broken);
   }
};

void LatticeGuardTest::aSoundMotifIsAccepted()
{
   HandMade motif;
   const auto made = motif.build();
   DIATOM_VERIFY_OK(made);
   const Lattice &l = **made;
   QCOMPARE(l.sites(), 2);
   QCOMPARE(l.rotations().size(), std::size_t{2});
   QVERIFY(std::abs(l.shape(0).volume / 1e-9 - 1) < 1e-12); // a cube of one millimetre, the default pitch
   QVERIFY(l.acrossFace(0, 5)->offset == (Index{0, 0, 1}));
}

// Sheared by one and a half steps, unlike any built-in lattice: rounding the coordinates is then wrong for
// many points.
void LatticeGuardTest::anObliqueBasisStillFindsTheNearestCell()
{
   HandMade motif;
   motif.basis = {2, 0, 0, 3, 2, 0, 1, 1, 2};
   motif.linkStart = {0, 0, 0};
   const auto made = motif.build();
   DIATOM_VERIFY_OK(made);
   const Lattice &l = **made;
   int beyondRounding = 0;
   for (int n = 0; n < 20000; ++n) {
      // A fixed irrational walk through some forty cells.
      const Vec3 point = 1e-3 * Vec3(std::remainder(n * 0.7548776662, 8), std::remainder(n * 0.5698402910, 8),
                                     std::remainder(n * 1.2207440846, 8));
      const Index found = l.nearest(point);
      const double distance = (l.position(found) - point).norm();
      for (int x = -8; x <= 8; ++x)
         for (int y = -6; y <= 6; ++y)
            for (int z = -4; z <= 4; ++z)
               if ((l.position({x, y, z}) - point).norm() < distance * (1 - 1e-9))
                  QFAIL("a nearer cell exists");
      // basis columns (2,0,0), (3,2,0), (1,1,2) mm solved by hand, then rounded
      const double z = point.z() / 2e-3, y = (point.y() - 1e-3 * z) / 2e-3;
      const double x = (point.x() - 3e-3 * y - 1e-3 * z) / 2e-3;
      beyondRounding += found != Index{static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)),
                                       static_cast<int>(std::lround(z))};
   }
   QVERIFY(beyondRounding > 1000); // the case is worth testing
}

void LatticeGuardTest::aLatticeThatIsNotInstalledIsNamed()
{
   LatticeSpec spec;
   spec.id = "org.example.nowhere";
   const auto made = Lattice::make(*test::catalogue(), spec, Job());
   QVERIFY(!made.ok());
   QVERIFY(made.error().message.find("org.example.nowhere") != std::string::npos);
}

QTEST_APPLESS_MAIN(LatticeGuardTest)
#include "lattice_guard_test.moc"
