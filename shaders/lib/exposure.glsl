// A histogram of exposure values: 0 EV is middle grey, 0.18; bins lie evenly from −16 to 16 EV.
const int kBins = 64;
const float kFirstBin = -16.0, kLastBin = 16.0;

float bin_of_ev(float ev) { return (clamp(ev, kFirstBin, kLastBin) - kFirstBin) * (float(kBins - 1) / (kLastBin - kFirstBin)); }
