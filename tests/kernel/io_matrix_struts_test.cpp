// All lattices that are installed x struts: one closed 2-manifold, outward, of the right volume, and
// independent checkers agree.
#include "kernel/io_matrix.h"

using namespace diatom;

class StrutMatrixTest : public QObject
{
   Q_OBJECT

private slots:
   void struts_data() { test::addMatrix(); }
   void struts();
   void cleanupTestCase();

private:
   std::filesystem::path file() const
   {
      return std::filesystem::path(m_folder.path().toStdString()) / "m.stl";
   }
   QTemporaryDir m_folder;
};

void StrutMatrixTest::struts()
{
   QFETCH(QString, lattice);
   QFETCH(bool, composite);
   const auto scene = test::matrixScene(lattice.toStdString(), composite);
   const auto hierarchy = scene.hierarchy();
   for (const bool connections : {false, true}) {
      GeometryOptions options;
      options.what = GeometryOptions::What::struts;
      options.apart = false;
      options.struts.connections = connections;
      options.struts.sides = 4;
      const auto geometry = makeGeometry(hierarchy, nullptr, options, Job());
      DIATOM_VERIFY_OK(geometry);
      if (geometry->struts.struts == 0)
         continue; // a lattice that joins nothing
      QCOMPARE(QString::fromStdString(test::fault(*geometry)), QString());
      // Thin struts have the volume of their prisms but for the joints, of which each side is some widths.
      const auto graph = strutGraph(hierarchy, connections, Job());
      DIATOM_VERIFY_OK(graph);
      double length = 0, shortest = 1e300;
      for (const Strut &strut : graph->struts) {
         length += graph->length(strut);
         shortest = std::min(shortest, graph->length(strut));
      }
      options.struts.width = shortest / 400;
      const auto thin = makeGeometry(hierarchy, nullptr, options, Job());
      DIATOM_VERIFY_OK(thin);
      const double wanted = length * options.struts.width * options.struts.width;
      QVERIFY2(std::abs(test::volume(*thin) / wanted - 1) < 0.05,
               qPrintable(QString::number(test::volume(*thin) / wanted)));
      QVERIFY(test::volume(*geometry) > test::volume(*thin));
      if (connections)
         continue;
      DIATOM_VERIFY_OK(writeGeometry(*geometry, GeometryFormat::stl, 1e-3, file(), Job()));
      if (!composite) // a slow checker
         QCOMPARE(QString::fromStdString(test::stlCheckFault(file(), test::volume(*geometry) * 1e9, true)),
                  QString());
      QCOMPARE(QString::fromStdString(test::admeshFault(file(), test::volume(*geometry) * 1e9)), QString());
      QCOMPARE(QString::fromStdString(test::slicerFault(file(), test::volume(*geometry) * 1e9)), QString());
   }
}

void StrutMatrixTest::cleanupTestCase()
{
   if (!test::haveAdmesh())
      qInfo("admesh was not there to judge the files: apt-get install admesh");
}

QTEST_GUILESS_MAIN(StrutMatrixTest)
#include "io_matrix_struts_test.moc"
