// The checks that hold the C contract still. Each returns "" or what the compiler or tool said, so that a
// test can ask both that the contract passes and that a broken one does not.
#pragma once

#include "support/process.h"
#include "support/support.h"

#include <QRegularExpression>

namespace diatom::test::abi {

struct Compiler
{
   QString name, c, cpp;
};

/// The build's compiler and the other one where it is installed.
inline std::vector<Compiler> compilers()
{
   std::vector<Compiler> found;
   for (const QString &line : QStringLiteral(DIATOM_ABI_COMPILERS).split('|', Qt::SkipEmptyParts)) {
      const QStringList words = line.split(',');
      found.push_back({words[0], words[1], words[2]});
   }
   return found;
}

inline std::filesystem::path currentHeaders() { return sourceDir() / "plugins/sdk/include"; }
inline std::filesystem::path abiDir() { return sourceDir() / "tests/abi"; }

inline QString text(const std::filesystem::path &path) { return QString::fromStdString(path.string()); }

inline QString complaint(const Outcome &outcome)
{
   if (outcome.exit == 0)
      return {};
   return outcome.err + outcome.out + QStringLiteral(" (exit %1)").arg(outcome.exit);
}

/// Names of the headers of the C contract, without the suffix.
inline QStringList headerNames(const std::filesystem::path &include)
{
   QStringList names;
   for (const auto &entry : std::filesystem::directory_iterator(include / "diatom/abi"))
      names << QString::fromStdString(entry.path().stem().string());
   names.sort();
   return names;
}

/// Every struct that a header defines.
inline QStringList structsOf(const std::filesystem::path &include, const QString &header)
{
   QFile file(text(include / "diatom/abi" / (header.toStdString() + ".h")));
   if (!file.open(QIODevice::ReadOnly))
      return {};
   QStringList names;
   static const QRegularExpression closing("^\\} (diatom_\\w+);", QRegularExpression::MultilineOption);
   for (auto match = closing.globalMatch(QString::fromUtf8(file.readAll())); match.hasNext();)
      names << match.next().captured(1);
   return names;
}

inline const QStringList &strict()
{
   static const QStringList options{"-Wall", "-Wextra", "-Wpedantic", "-Wpadded", "-Werror", "-fsyntax-only"};
   return options;
}

/// Each header alone, twice included, in one language. clang lays a struct out, and so tells its padding,
/// only where its size is asked for.
inline QString headersFault(const std::filesystem::path &include, const Compiler &compiler,
                            const QString &standard, const QStringList &headers)
{
   const bool c = standard == "c11";
   QString fault;
   for (const QString &header : headers) {
      const QString line = QStringLiteral("#include <diatom/abi/%1.h>\n").arg(header);
      QString source = line + line;
      for (const QString &type : structsOf(include, header))
         source += QStringLiteral("typedef char size_of_%1[sizeof(%1)];\n").arg(type);
      fault += complaint(
          run(c ? compiler.c : compiler.cpp,
              strict() + QStringList{"-std=" + standard, "-I" + text(include), "-x", c ? "c" : "c++", "-"},
              source.toUtf8()));
   }
   return fault;
}

/// The list of one release against headers.
inline QString freezeFault(const std::filesystem::path &include, const Compiler &compiler,
                           const std::filesystem::path &list)
{
   return complaint(run(compiler.c, strict() + QStringList{"-std=c11", "-I" + text(include), text(list)}));
}

/// What abidiff says about the anchor library built with headers, against a stored snapshot.
inline QString snapshotFault(const std::filesystem::path &include, const Compiler &compiler,
                             const std::filesystem::path &snapshot)
{
   const QTemporaryDir folder;
   const QString library = folder.filePath("anchor.so");
   const Outcome built = run(compiler.c, {"-std=c11", "-g", "-shared", "-fPIC", "-I" + text(include),
                                          text(abiDir() / "anchor.c"), "-o", library});
   if (built.exit != 0)
      return complaint(built);
   return complaint(run("abidiff", {"--no-added-syms", text(snapshot), library}));
}

/// "" when the library exports the module record alone, else all that it exports.
inline QString exportsFault(const std::filesystem::path &library)
{
   const Outcome nm = run("nm", {"-D", "--defined-only", "--format=posix", text(library)});
   if (nm.exit != 0)
      return complaint(nm);
   QStringList symbols;
   for (const QString &line : QString::fromUtf8(nm.out).split('\n', Qt::SkipEmptyParts))
      symbols << line.section(' ', 0, 0);
   return symbols == QStringList{"diatom_module_v1"} ? QString() : "it exports: " + symbols.join(", ");
}

} // namespace diatom::test::abi
