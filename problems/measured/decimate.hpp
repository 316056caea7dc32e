// SPDX-License-Identifier: MIT
//
// Decimation as identification software does it: a zero-phase low pass, then every n-th sample.
//
// The filter is a Chebyshev type I of order 8 with 0.05 dB of ripple and a cut-off of 0.8 of the
// new Nyquist frequency, run forwards and backwards over the record extended by 24 samples of its
// point reflection at either end: the method of MATLAB's `decimate`, which the published EMPS
// errors were made with. We differ in that the gain at frequency 0 is 1.
#pragma once

#include <span>
#include <vector>

namespace tribench::measured {

// Samples 0, factor, 2 factor, ... of the filtered signal. factor >= 1 (1 copies); signals of
// up to 25 samples are not filtered. Cost O(size).
std::vector<double> decimate(std::span<const double> signal, int factor);

}  // namespace tribench::measured
