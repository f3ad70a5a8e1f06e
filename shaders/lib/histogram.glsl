// SPDX-License-Identifier: MIT
// A histogram that the invocations of a workgroup fill together: for compute shaders. Counts are whole numbers, so that it does not matter who
// comes first. Between filling and reading stands a `barrier()` that all invocations reach.

const uint kHistogramBins = 256u;

shared uint histogram_bins[kHistogramBins];

void histogram_add(uint bin) { atomicAdd(histogram_bins[min(bin, kHistogramBins - 1u)], 1u); }
uint histogram_count(uint bin) { return bin < kHistogramBins ? histogram_bins[bin] : 0u; }
