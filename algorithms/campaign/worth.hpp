// SPDX-License-Identifier: MIT
//
// How much smaller the squared error is for an effect, in rows as they are, each stretch predicted
// from the others: what decides whether an effect is next to nothing. No form of the library is
// the true one to the last per cent, and what a large effect's form lacks some small effect can
// mimic. However many rows say so, that is no cause; and it is where stories change when the
// recording is told again.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "algorithms/campaign/fitted_model.hpp"

namespace tribench::loop {

// Of each family: by how much the squared error is larger without it, as a share.
std::vector<double> worths(const LoopModel& model, const std::vector<std::size_t>& families,
                           const Campaign& campaign);

// Less is next to nothing beside effects of these worths: a share of what is left, and of the
// largest of them. -1 beside none, where everything counts.
double least_worth(const std::vector<double>& beside, const DiagnosisOptions& options);

// Less is next to nothing of what no family explains, beside a model with these.
double least_worth_of_leftover(const LoopModel& model, const std::vector<std::size_t>& families,
                               const Campaign& campaign);

// By how much columns beside the model make the squared error smaller, as a share. ridge: on them.
double worth_of(const Eigen::MatrixXd& columns, const LoopModel& model, const Campaign& campaign,
                double ridge = 0);

}  // namespace tribench::loop
