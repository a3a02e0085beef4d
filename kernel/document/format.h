// The .diatom format, version 1, between Design and JSON. resources/schema/diatom-1.schema.json describes it.
#pragma once

#include "core/archive.h"
#include "core/job.h"
#include "document/design.h"
#include "document/json_place.h"

#include <nlohmann/json.hpp>

namespace diatom {

inline constexpr int kFormatVersion = 1;
inline constexpr const char *kDocumentEntry = "document.json"; // of the zip form

/// The document as JSON. With `blocks` cells are packed into it and the JSON names the entries.
Result<nlohmann::ordered_json> designJson(const Design &design, Entries *blocks, const Job &job);

/// The design a document says. Faults and unknown keys go to `log`; `blocks` are the other entries of the zip
/// form.
Design readDesignJson(const nlohmann::json &document, const Entries &blocks, ReadLog &log, const Job &job);

/// Parts shared with the commands, which take materials and set-ups in the same words.
nlohmann::ordered_json materialJson(const Material &material);
Material readMaterial(const JsonPlace &place);
nlohmann::ordered_json sourceJson(const Source &source);
Source readSource(const JsonPlace &place);
nlohmann::ordered_json groundJson(const Ground &ground);
Ground readGround(const JsonPlace &place, Ground ground);
/// Keys "cell", "box" or "material" of an entry.
nlohmann::ordered_json whereJson(const Where &where);
Where readWhere(const JsonPlace &place);
nlohmann::ordered_json supportJson(const Support &support);
Support readSupport(const JsonPlace &place);
nlohmann::ordered_json driveJson(const Drive &drive);
Drive readDrive(const JsonPlace &place);
nlohmann::ordered_json loadJson(const Load &load);
Load readLoad(const JsonPlace &place);
nlohmann::ordered_json startJson(const Start &start);
Start readStart(const JsonPlace &place);
nlohmann::ordered_json referenceMeshJson(const ReferenceMesh &reference);
ReferenceMesh readReferenceMesh(const JsonPlace &place);
/// Refuses two of one name.
std::vector<ReferenceMesh> readReferenceMeshes(const JsonPlace &list);
nlohmann::ordered_json fieldJson(const Field &field);
Field readField(const JsonPlace &place);
nlohmann::ordered_json valuesJson(const Values &values);
nlohmann::ordered_json fixedJson(std::uint8_t fixed);
std::uint8_t readFixed(const JsonPlace &place);
nlohmann::ordered_json setupJson(const Setup &setup);
/// Entries on a material that `model` does not have are refused.
Setup readSetup(const JsonPlace &place, const Model &model);
nlohmann::ordered_json indexJson(Index index);

/// Refuses two sources of one cell, and sorts supports.
void orderSetup(Setup &setup, const JsonPlace &place);

} // namespace diatom
