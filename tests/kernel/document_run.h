// Editing commands as tests run them: done, or refused with a sentence and without a trace.
#pragma once

#include "document/document.h"

#include <QTest>

#include <nlohmann/json.hpp>

#include <string>

namespace diatom::test {

/// Runs and returns the error's message, "" when it worked.
inline std::string run(Document &document, const char *command, const char *arguments)
{
   const auto done = document.run(command, nlohmann::json::parse(arguments), Job());
   return done.ok() ? std::string() : done.error().message;
}

} // namespace diatom::test

/// On a document `d`.
#define DO(command, arguments) QCOMPARE(diatom::test::run(d, command, arguments), std::string())
#define REFUSED(command, arguments, says)                                                                    \
   do {                                                                                                      \
      const auto hashBefore = d.design().hash();                                                             \
      const auto message = diatom::test::run(d, command, arguments);                                         \
      QVERIFY2(message.find(says) != std::string::npos, message.c_str());                                    \
      QVERIFY2(message.starts_with(command), message.c_str());                                               \
      QVERIFY(d.design().hash() == hashBefore);                                                              \
   } while (false)
