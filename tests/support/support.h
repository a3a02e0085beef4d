// What tests share: where things are, and the installed catalogue.
#pragma once

#include "core/job.h"
#include "core/sanitizers.h"
#include "plugins/catalogue.h"

#include <QTemporaryDir>
#include <QTest>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

namespace diatom::test {

/// ms that a window may take for what is asked of it.
inline constexpr int kPatience = 60'000 * kSlowdown;

inline std::filesystem::path sourceDir()
{
   const char *dir = std::getenv("DIATOM_SOURCE_DIR");
   return dir ? dir : ".";
}

/// Build folder: executables in bin/.
inline std::filesystem::path binaryDir()
{
   const char *dir = std::getenv("DIATOM_BINARY_DIR");
   return dir ? dir : ".";
}

/// Reference data beside the project; empty when it is not there.
inline std::filesystem::path sharedDir()
{
   const auto dir = sourceDir() / ".." / "shared";
   return std::filesystem::exists(dir) ? std::filesystem::canonical(dir) : std::filesystem::path();
}

inline std::filesystem::path samplesDir() { return sourceDir() / "resources" / "samples"; }

/// The plugins built with the tests.
inline std::shared_ptr<const Catalogue> catalogue()
{
   static const auto found = Catalogue::find(defaultPluginFolders());
   return found;
}

} // namespace diatom::test

/// Skips the test with a clear message when the reference data is not beside the project.
#define DIATOM_NEEDS_SHARED()                                                                                \
   if (diatom::test::sharedDir().empty())                                                                    \
   QSKIP("the reference data (../shared) is not beside the project")

/// Fails with the Result's own message.
#define DIATOM_VERIFY_OK(result)                                                                             \
   do {                                                                                                      \
      const auto &checked = (result);                                                                        \
      QVERIFY2(checked.ok(), checked.ok() ? "" : checked.error().message.c_str());                           \
   } while (false)
