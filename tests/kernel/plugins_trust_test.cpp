// Consent: what lies in the user's plugin folder runs only when the user said so for this very library,
// nothing is loaded from the current directory, and a design file loads nothing.
#include "core/file.h"
#include "core/sha256.h"
#include "lattice/lattice.h"
#include "plugins/consent.h"
#include "support/support.h"

#include <QCryptographicHash>

using namespace diatom;
namespace fs = std::filesystem;

namespace {

constexpr const char *kPlugin = "test.misbehaving", *kThing = "test.echo";

fs::path built() { return test::binaryDir() / "tests/plugins/faulty/misbehaving"; }

} // namespace

class PluginsTrustTest : public QObject
{
   Q_OBJECT
private slots:
   void init();
   void hashesAreSha256();
   void withoutConsentNothingRuns();
   void consentIsForOneLibrary();
   void aDamagedListTrustsNothing();
   void anExplicitFolderIsConsent();
   void theCurrentDirectoryIsNotLookedIn();
   void aDesignLoadsNothing();

private:
   fs::path root() const { return m_dir->path().toStdString(); }
   fs::path userFolder() const { return root() / "data/diatom/plugins/1"; }
   static std::shared_ptr<const Catalogue> start() { return Catalogue::find(defaultPluginFolders()); }
   static const Candidate *candidate(const Catalogue &catalogue);
   /// The error of using the plugin's thing; it always refuses, with its own words when it runs.
   static std::string use(const Catalogue &catalogue);
   static bool ran(const std::string &error)
   {
      return error.find("1.500000 3.000000 fast") != std::string::npos;
   }
   std::unique_ptr<QTemporaryDir> m_dir;
};

void PluginsTrustTest::init()
{
   m_dir = std::make_unique<QTemporaryDir>();
   for (const char *kind : {"data", "config", "cache"})
      qputenv(qPrintable(QString("XDG_%1_HOME").arg(QString(kind).toUpper())),
              (m_dir->path() + "/" + kind).toUtf8());
   qunsetenv("DIATOM_PLUGIN_PATH");
   fs::create_directories(userFolder());
   fs::copy(built(), userFolder() / "misbehaving", fs::copy_options::recursive);
}

const Candidate *PluginsTrustTest::candidate(const Catalogue &catalogue)
{
   for (const Candidate &one : catalogue.candidates())
      if (one.manifest.id == kPlugin)
         return &one;
   return nullptr;
}

std::string PluginsTrustTest::use(const Catalogue &catalogue)
{
   const auto made = catalogue.create<diatom_lattice>(DIATOM_LATTICE_1, kThing, {}, Job());
   return made.ok() ? "it was made" : made.error().message;
}

/// Reference: Qt's own, for lengths about the borders of blocks.
void PluginsTrustTest::hashesAreSha256()
{
   QByteArray bytes;
   for (int length = 0; length < 200; ++length) {
      QCOMPARE(QByteArray::fromStdString(sha256({bytes.constData(), std::size_t(bytes.size())})),
               QCryptographicHash::hash(bytes, QCryptographicHash::Sha256).toHex());
      bytes.append(static_cast<char>(37 * length + 11));
   }
}

void PluginsTrustTest::withoutConsentNothingRuns()
{
   const auto catalogue = start();
   const Candidate *found = candidate(*catalogue);
   QVERIFY(found && !found->accepted);
   QCOMPARE(found->origin, Origin::user);
   QVERIFY2(found->verdict.find("`diatom plugins trust test.misbehaving`") != std::string::npos,
            found->verdict.c_str());
   QVERIFY(!catalogue->offer(DIATOM_LATTICE_1, kThing));
   const std::string error = use(*catalogue);
   QVERIFY2(!ran(error) && error.find("diatom plugins trust") != std::string::npos, error.c_str());
   // Not even on trial.
   const auto tried = Catalogue::find(defaultPluginFolders(), true);
   QVERIFY(!candidate(*tried)->accepted);
}

void PluginsTrustTest::consentIsForOneLibrary()
{
   const auto decided = trustPlugin(*start(), kPlugin);
   DIATOM_VERIFY_OK(decided);
   QCOMPARE(decided->size(), std::size_t{1});
   QVERIFY(candidate(*start())->accepted);
   const auto catalogue = start();
   QVERIFY2(ran(use(*catalogue)), use(*catalogue).c_str());
   // Twice is once.
   const std::string list = *readFile(root() / "config/diatom/trusted_plugins.json");
   DIATOM_VERIFY_OK(trustPlugin(*start(), kPlugin));
   QCOMPARE(*readFile(root() / "config/diatom/trusted_plugins.json"), list);

   // Another library under the same name asks again, also where its size and time are the old ones.
   const fs::path library = userFolder() / "misbehaving/misbehaving.so";
   const auto time = fs::last_write_time(library);
   const auto before = start(); // has seen the trusted one
   std::string bytes = *readFile(library);
   bytes.back() = static_cast<char>(bytes.back() ^ 1);
   DIATOM_VERIFY_OK(writeFileAtomic(library, bytes));
   fs::last_write_time(library, time);
   QVERIFY2(use(*before).find("diatom plugins trust") != std::string::npos, use(*before).c_str());
   fs::last_write_time(library, time + std::chrono::seconds(1));
   QVERIFY(!candidate(*start())->accepted);
   QVERIFY(!trustPlugin(*start(), "test.absent").ok());
}

void PluginsTrustTest::aDamagedListTrustsNothing()
{
   DIATOM_VERIFY_OK(trustPlugin(*start(), kPlugin));
   DIATOM_VERIFY_OK(
       writeFileAtomic(root() / "config/diatom/trusted_plugins.json", "{\"schema\": 1, \"trusted\": {"));
   QVERIFY(!candidate(*start())->accepted);
   DIATOM_VERIFY_OK(trustPlugin(*start(), kPlugin));
   QVERIFY(candidate(*start())->accepted);
}

void PluginsTrustTest::anExplicitFolderIsConsent()
{
   const auto chosen = Catalogue::find({userFolder()});
   QCOMPARE(candidate(*chosen)->origin, Origin::chosen);
   QVERIFY2(ran(use(*chosen)), use(*chosen).c_str());
   qputenv("DIATOM_PLUGIN_PATH", userFolder().c_str());
   const auto byEnvironment = start();
   QVERIFY2(ran(use(*byEnvironment)), use(*byEnvironment).c_str());
   qunsetenv("DIATOM_PLUGIN_PATH");
   // What is installed with the program needs neither.
   const auto installed = start();
   QCOMPARE(installed->offer(DIATOM_LATTICE_1, "org.diatom_cad.lattice.cube")->candidate->origin,
            Origin::installed);
}

void PluginsTrustTest::theCurrentDirectoryIsNotLookedIn()
{
   const fs::path here = fs::current_path();
   fs::rename(userFolder() / "misbehaving", root() / "misbehaving");
   for (const fs::path &folder : {root(), root() / "misbehaving"}) {
      fs::current_path(folder);
      qputenv("DIATOM_PLUGIN_PATH", ".:plugins:misbehaving:..:");
      const bool found = candidate(*start()) != nullptr;
      fs::current_path(here);
      QVERIFY(!found);
   }
   qunsetenv("DIATOM_PLUGIN_PATH");
}

/// A design names things by id only. One that lies in the user's folder untrusted, or beside the design, is
/// not loaded: the library's constructor would end this process.
void PluginsTrustTest::aDesignLoadsNothing()
{
   fs::copy(built().parent_path() / "crashes", userFolder() / "crashes", fs::copy_options::recursive);
   fs::copy(built().parent_path() / "crashes", root() / "crashes", fs::copy_options::recursive);
   for (const std::string &id :
        {std::string("test.crashes"), (root() / "crashes").string(), (root() / "crashes/crashes.so").string(),
         std::string("../crashes/crashes.so")})
   {
      LatticeSpec spec;
      spec.id = id;
      const auto lattice = Lattice::make(*start(), spec, Job());
      QVERIFY(!lattice.ok());
      QVERIFY2(lattice.error().message.find(id) != std::string::npos, lattice.error().message.c_str());
   }
}

QTEST_APPLESS_MAIN(PluginsTrustTest)
#include "plugins_trust_test.moc"
