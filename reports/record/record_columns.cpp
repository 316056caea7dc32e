// SPDX-License-Identifier: MIT
#include "reports/record/record_columns.hpp"

namespace tribench {
namespace {

using R = Record;
constexpr RecordColumn<Record> kResultColumns[] = {
    {"cell", &R::cell},
    {"problem", &R::problem},
    {"dataset", &R::dataset},
    {"joint", &R::joint},
    {"load", &R::load},
    {"method", &R::method},
    {"operators", &R::operators},
    {"seed", &R::seed},
    {"status", &R::status},
    {"reason", &R::reason},
    {"mae_train", &R::mae_train},
    {"mae_test", &R::mae_test},
    {"rmse_test", &R::rmse_test},
    {"max_error_test", &R::max_error_test},
    {"r2_test", &R::r2_test},
    {"mae_truth", &R::mae_truth},
    {"complexity", &R::complexity, {.needs_formula = true}},
    {"nodes", &R::nodes, {.needs_formula = true}},
    {"evaluations", &R::evaluations},
    {"fit_cpu_s", &R::fit_cpu_s, {.is_cost = true}},
    {"fit_wall_s", &R::fit_wall_s, {.is_cost = true}},
    {"peak_memory_mib", &R::peak_memory_mib, {.is_cost = true}},
    {"eval_ns_per_row", &R::eval_ns_per_row, {.is_cost = true}},
    {"singularity", &R::singularity},
    {"witness", &R::witness},
    {"formula", &R::formula},
    {"relative_error_train", &R::relative_error_train},
    {"relative_error_test", &R::relative_error_test},
    {"complexity_adaptation", &R::complexity_adaptation, {.needs_formula = true}},
    {"mae_ceiling", &R::mae_ceiling},
    {"mae_law", &R::mae_law},
    {"mae_refitted", &R::mae_refitted},
    {"mae_truth_refitted", &R::mae_truth_refitted},
    {"grid_check", &R::grid_check},
    {"dissipative", &R::dissipative},
    {"monotone", &R::monotone},
    {"odd", &R::odd},
    {"fit_instructions", &R::fit_instructions, {.is_cost = true, .may_be_absent = true}},
    {"motion_error", &R::motion_error, {.may_be_absent = true, .only_where_known = true}},
    {"note", &R::note},
};

using F = FrontRecord;
constexpr RecordColumn<FrontRecord> kFrontColumns[] = {
    {"cell", &F::cell},           {"complexity", &F::complexity}, {"nodes", &F::nodes},
    {"mae_train", &F::mae_train}, {"mae_test", &F::mae_test},     {"singularity", &F::singularity},
    {"chosen", &F::chosen},       {"formula", &F::formula},
};

using T = TraceRecord;
constexpr RecordColumn<TraceRecord> kTraceColumns[] = {
    {"cell", &T::cell},
    {"evaluations", &T::evaluations},
    {"cpu_s", &T::cpu_s},
    {"train_error", &T::train_error},
};

using C = CurveRecord;
constexpr RecordColumn<CurveRecord> kCurveColumns[] = {
    {"cell", &C::cell},
    {"problem", &C::problem},
    {"method", &C::method},
    {"operators", &C::operators},
    {"picture", &C::picture},
    {"curve", &C::curve},
    {"x_name", &C::x_name},
    {"y_name", &C::y_name},
    {"x", &C::x},
    {"y", &C::y},
};

using P = PlannedCell;
constexpr RecordColumn<PlannedCell> kPlannedColumns[] = {
    {"cell", &P::cell},           {"problem", &P::problem}, {"method", &P::method},
    {"operators", &P::operators}, {"seed", &P::seed},
};

}  // namespace

std::span<const RecordColumn<Record>> result_columns() { return kResultColumns; }
std::span<const RecordColumn<FrontRecord>> front_columns() { return kFrontColumns; }
std::span<const RecordColumn<TraceRecord>> trace_columns() { return kTraceColumns; }
std::span<const RecordColumn<CurveRecord>> curve_columns() { return kCurveColumns; }
std::span<const RecordColumn<PlannedCell>> planned_columns() { return kPlannedColumns; }

}  // namespace tribench
