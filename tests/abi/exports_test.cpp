// Every plugin exports exactly one symbol, so that two plugins can never see each other's.
#include "abi/contract.h"

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
         const QString fault = test::abi::exportsFault(entry.path());
         QVERIFY2(fault.isEmpty(), qPrintable(test::abi::text(entry.path()) + ": " + fault));
         ++plugins;
      }
      QVERIFY(plugins > 0);
   }
};

QTEST_APPLESS_MAIN(ExportsTest)
#include "exports_test.moc"
