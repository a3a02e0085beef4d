// Child processes of tests, run to their end.
#pragma once

#include <QByteArray>
#include <QFile>
#include <QStringList>
#include <QTemporaryDir>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <vector>

namespace diatom::test {

/// What a child wrote and how it ended; -1 when it did not start or was killed by a signal.
struct Outcome
{
   int exit = -1;
   QByteArray out, err;
};

/// Runs a program found in PATH. Not by QProcess, whose bare clone() ends the run under ThreadSanitizer (the
/// runtime of clang 14 fails its own check in ForkAfter); the C library's spawn is not seen by it.
inline Outcome run(const QString &program, const QStringList &arguments, const QByteArray &input = {})
{
   const QTemporaryDir folder;
   const QByteArray in = folder.filePath("in").toUtf8(), out = folder.filePath("out").toUtf8(),
                    err = folder.filePath("err").toUtf8();
   if (QFile file(in); !file.open(QIODevice::WriteOnly) || file.write(input) != input.size())
      return {};
   std::vector<QByteArray> words{program.toUtf8()};
   for (const QString &argument : arguments)
      words.push_back(argument.toUtf8());
   std::vector<char *> argv;
   for (QByteArray &word : words)
      argv.push_back(word.data());
   argv.push_back(nullptr);
   posix_spawn_file_actions_t files;
   posix_spawn_file_actions_init(&files);
   posix_spawn_file_actions_addopen(&files, STDIN_FILENO, in, O_RDONLY, 0);
   posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out, O_WRONLY | O_CREAT, 0600);
   posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err, O_WRONLY | O_CREAT, 0600);
   pid_t child = 0;
   const bool started = posix_spawnp(&child, argv[0], &files, nullptr, argv.data(), environ) == 0;
   posix_spawn_file_actions_destroy(&files);
   int status = 0;
   if (!started || waitpid(child, &status, 0) != child)
      return {};
   const auto text = [](const QByteArray &name) {
      QFile file(name);
      return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
   };
   return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text(out), text(err)};
}

} // namespace diatom::test
