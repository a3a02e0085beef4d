// All lattices that are installed x cells and parts: closed, 2-manifold, outward, of the right
// volume, and independent checkers agree.
#include "kernel/io_matrix.h"

using namespace diatom;

namespace {

/// Of the bricks that are made for one height of cells alone; 0 for all others.
double heightFor(const std::string &maker)
{
   return maker.find("dna") != std::string::npos ? 1.08 : maker.find("lego") != std::string::npos ? 1.17 : 0;
}

} // namespace

class MatrixTest : public QObject
{
   Q_OBJECT

private slots:
   void cells_data() { test::addMatrix(); }
   void cells();
   void parts_data() { test::addMatrix(); }
   void parts();
   void cleanupTestCase();

private:
   std::filesystem::path file() const
   {
      return std::filesystem::path(m_folder.path().toStdString()) / "m.stl";
   }
   QTemporaryDir m_folder;
};

void MatrixTest::cells()
{
   QFETCH(QString, lattice);
   QFETCH(bool, composite);
   const auto scene = test::matrixScene(lattice.toStdString(), composite);
   const auto hierarchy = scene.hierarchy();
   const double wanted = test::cellVolume(hierarchy);
   for (const bool apart : {true, false}) {
      GeometryOptions options;
      options.apart = apart;
      const auto geometry = makeGeometry(hierarchy, nullptr, options, Job());
      DIATOM_VERIFY_OK(geometry);
      QCOMPARE(QString::fromStdString(test::fault(*geometry)), QString());
      QVERIFY(std::abs(test::volume(*geometry) / wanted - 1) < 1e-9); // rounding of some thousand terms
   }
   DIATOM_VERIFY_OK(writeStl(hierarchy, nullptr, {}, file(), Job()));
   if (!composite) // a slow checker
      QCOMPARE(QString::fromStdString(test::stlCheckFault(file(), wanted * 1e9, false)), QString());
   QCOMPARE(QString::fromStdString(test::admeshFault(file(), wanted * 1e9)), QString());
   QCOMPARE(QString::fromStdString(test::slicerFault(file(), wanted * 1e9)), QString());
}

void MatrixTest::parts()
{
   QFETCH(QString, lattice);
   QFETCH(bool, composite);
   int makers = 0;
   for (const Offer &offer : test::catalogue()->offers(DIATOM_PARTS_1)) {
      const auto maker =
          PartMaker::make(*test::catalogue(), offer.provided->id, {}, lattice.toStdString(), Job());
      if (!maker)
         continue;
      ++makers;
      const auto scene = test::matrixScene(lattice.toStdString(), composite, heightFor(offer.provided->id));
      const auto hierarchy = scene.hierarchy();
      const auto list = (*maker)->decompose(hierarchy, Job());
      DIATOM_VERIFY_OK(list);
      if (list->parts.empty())
         continue;
      double wanted = 0; // of the plugin's own meshes
      std::map<std::pair<int, int>, double> each;
      for (const Part &part : list->parts) {
         const auto [found, added] = each.emplace(std::pair(part.type, part.length), 0.0);
         if (added) {
            const auto mesh = (*maker)->mesh(part.type, part.length, 0, scene.model.lattice.pitch, Job());
            DIATOM_VERIFY_OK(mesh);
            for (const auto &[a, b, c] : mesh->triangles)
               found->second += mesh->vertices[std::size_t(a)].dot(
                                    mesh->vertices[std::size_t(b)].cross(mesh->vertices[std::size_t(c)])) /
                                6;
         }
         wanted += found->second;
      }
      GeometryOptions options;
      options.what = GeometryOptions::What::parts;
      options.detail = 0;
      const auto geometry = makeGeometry(hierarchy, maker->get(), options, Job());
      DIATOM_VERIFY_OK(geometry);
      QVERIFY2(test::fault(*geometry).empty(), (offer.provided->id + ": " + test::fault(*geometry)).c_str());
      QVERIFY(std::abs(test::volume(*geometry) / wanted - 1) < 1e-9);
      StlOptions stl;
      stl.what = StlOptions::What::parts;
      stl.detail = 0;
      DIATOM_VERIFY_OK(writeStl(hierarchy, maker->get(), stl, file(), Job()));
      if (!composite)
         QCOMPARE(QString::fromStdString(test::stlCheckFault(file(), wanted * 1e9, false)), QString());
      QCOMPARE(QString::fromStdString(test::admeshFault(file(), wanted * 1e9)), QString());
      QCOMPARE(QString::fromStdString(test::slicerFault(file(), wanted * 1e9)), QString());
   }
   if (makers == 0)
      QSKIP("no parts plugin fits this lattice");
}

void MatrixTest::cleanupTestCase()
{
   if (!test::haveAdmesh())
      qInfo("admesh was not there to judge the files: apt-get install admesh");
}

QTEST_GUILESS_MAIN(MatrixTest)
#include "io_matrix_test.moc"
