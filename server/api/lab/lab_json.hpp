/// Records of the model lab in the JSON form of the routes.
#pragma once

#include "db/store/lab/lab.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

core::Json model_json(const store::ModelVersion& model);
core::Json set_json(const store::MeasurementSet& set);

/// A run without what it found, for lists: `ranking`, `diagnosis`, `fit`, `comparisons` and
/// `tract_map` are null.
core::Json run_json(const store::LabRun& run, const std::optional<store::ModelVersion>& published);
/// A run with its results, which are read from objects. Errors: those of reading.
core::Result<core::Json> whole_run_json(const Call& call, const store::LabRun& run);

/// The user effects of a run, as the request contained them.
core::Json own_effects(const store::LabRun& run);

/// Of files: ModelFile, EffectFile, MotionProgram and what they hold.
std::vector<NamedSchema> lab_file_schemas();
std::vector<NamedSchema> lab_model_schemas();
std::vector<NamedSchema> lab_run_schemas();
/// Of what the lab answers: Comparison, Diagnosis, Fit, TractMap and what they hold.
std::vector<NamedSchema> lab_answer_schemas();

/// research_route under /api/v1/lab.
RouteInfo lab_route(std::string method, std::string tail, std::string id, std::string summary,
                    std::string answer, core::Result<http::Response> (*handle)(const Call&));
/// An optional argument in the query.
Parameter optional_text(std::string name, std::string meaning);

}  // namespace tractus::api
