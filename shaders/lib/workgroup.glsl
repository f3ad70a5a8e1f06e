// SPDX-License-Identifier: MIT
// What the invocations of a workgroup find together: for compute shaders. All of them must call these functions, at the same place of
// the program, never inside of an `if` that only some take. Values are combined as a tree whose shape depends on the size of the workgroup alone,
// so that the same values always give the same bits.

const uint kInvocations = gl_WorkGroupSize.x * gl_WorkGroupSize.y;
const int kSum = 0, kMax = 1, kMin = 2;

shared vec4 combined[kInvocations];

// A NaN in either stays in all three.
vec4 combine(int how, vec4 a, vec4 b) {
  if (how == kSum) return a + b;
  bvec4 wins = how == kMax ? greaterThan(a, b) : lessThan(a, b);
  return mix(b, a, bvec4(uvec4(wins) | uvec4(isnan(a))));
}

vec4 of_workgroup(int how, vec4 value) {
  uint own = gl_LocalInvocationIndex;
  combined[own] = value;
  barrier();
  for (uint count = kInvocations; count > 1u; count = (count + 1u) / 2u) {
    uint other = own + (count + 1u) / 2u;
    if (other < count) combined[own] = combine(how, combined[own], combined[other]);
    barrier();
  }
  vec4 whole = combined[0];
  barrier();  // before somebody combines other values
  return whole;
}

// Of the values of all invocations: their sum, the largest, the smallest. Each invocation gets it.
vec4 workgroup_sum(vec4 value) { return of_workgroup(kSum, value); }
vec4 workgroup_max(vec4 value) { return of_workgroup(kMax, value); }
vec4 workgroup_min(vec4 value) { return of_workgroup(kMin, value); }
float workgroup_sum(float value) { return of_workgroup(kSum, vec4(value)).x; }
float workgroup_max(float value) { return of_workgroup(kMax, vec4(value)).x; }
float workgroup_min(float value) { return of_workgroup(kMin, vec4(value)).x; }
