// Every plugin exports exactly one symbol, so that two plugins can never see each other's.
#include "support/process.h"
#include "support/support.h"

#include <QStandardPaths>

using namespace diatom;
namespace fs = std::filesystem;

class ExportsTest : public QObject
{
   Q_OBJECT
private slots:
   void everyPluginExportsTheModuleRecordAlone()
   {
      if (QStandardPaths::findExecutable("nm").isEmpty())
         QSKIP("nm (binutils) is not installed");
      int plugins = 0;
      for (const auto &entry : fs::recursive_directory_iterator(test::binaryDir() / "plugins")) {
         if (entry.path().extension() != ".so")
            continue;
         const test::Outcome nm = test::run(
             "nm", {"-D", "--defined-only", "--format=posix", QString::fromStdString(entry.path().string())});
         QCOMPARE(nm.exit, 0);
         QStringList symbols;
         for (const QString &line : QString::fromUtf8(nm.out).split('\n', Qt::SkipEmptyParts))
            symbols << line.section(' ', 0, 0);
         QCOMPARE(symbols, QStringList{"diatom_module_v1"});
         ++plugins;
      }
      QVERIFY(plugins > 0);
   }
};

QTEST_APPLESS_MAIN(ExportsTest)
#include "exports_test.moc"
