// SPDX-License-Identifier: MIT
// A histogram of exposure values: 0 EV is middle grey, 0.18; bins lie evenly from −16 to 16 EV.
const int kBins = 64;
const float kFirstBin = -16.0, kLastBin = 16.0;

float bin_of_ev(float ev) { return (clamp(ev, kFirstBin, kLastBin) - kFirstBin) * (float(kBins - 1) / (kLastBin - kFirstBin)); }

// The mean of a histogram without its ends, bin by bin from the darkest on.
struct Percentiles {
  float skip, rest;  // weight that still has to be left out, and then counted
  float sum, count;
};

Percentiles between(vec2 percentiles, float total) {
  return Percentiles(total * percentiles.x, total * (percentiles.y - percentiles.x), 0.0, 0.0);
}

// `bin`: weight, and weight times exposure value.
void add_bin(inout Percentiles p, vec2 bin) {
  float dark = min(bin.x, p.skip);
  p.skip -= dark;
  float counted = min(bin.x - dark, p.rest);
  p.rest -= counted;
  if (counted > 0.0) p.sum += counted * (bin.y / bin.x);
  p.count += counted;
}

float mean_of(Percentiles p, vec2 limits) { return clamp(p.sum / max(p.count, 1e-20), limits.x, limits.y); }
