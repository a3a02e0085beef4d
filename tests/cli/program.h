// The command line program, run as a user runs it.
#pragma once

#include "support/process.h"
#include "support/support.h"

#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>

namespace diatom::test {

/// What the program printed, also as JSON.
struct Printed : Outcome
{
   QJsonDocument json() const { return QJsonDocument::fromJson(out); }
   QJsonObject object() const { return json().object(); }
};

inline Printed diatomRuns(const QStringList &arguments, const QByteArray &input = {})
{
   return {run(QString::fromStdString((binaryDir() / "bin" / "diatom").string()), arguments, input)};
}

} // namespace diatom::test
