// An accuracy study for people and programs: table, JSON and chart.
#pragma once

#include "study/accuracy_study.h"
#include "study/plot.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace diatom {

/// One line per row, with a heading.
std::string accuracyCsv(const AccuracyStudy &study);
nlohmann::ordered_json accuracyJson(const AccuracyStudy &study);
/// Error against seconds of wall time: one line per integrator and precision of the scene's own model, points
/// for the rest, the front, the tolerance, and the cheapest setting.
Chart accuracyChart(const AccuracyStudy &study);

/// Writes accuracy.csv, accuracy.json, accuracy.svg and accuracy.png into a folder, which is made if need be.
/// The plots are left out of a build that cannot draw, and the study's notes then say so.
Status writeAccuracy(AccuracyStudy &study, const std::filesystem::path &folder);

} // namespace diatom
