// SPDX-License-Identifier: MIT
// Ways of pixels: the longest of many, and the one that leads farthest aside of it.

vec2 longer_of(vec2 a, vec2 b) { return dot(b, b) > dot(a, a) ? b : a; }

/// Area between two ways.
float between(vec2 a, vec2 b) { return abs(a.x * b.y - a.y * b.x); }

/// Of two ways the one that leads farther aside of `most`.
vec2 farther_aside(vec2 most, vec2 a, vec2 b) { return between(most, b) > between(most, a) ? b : a; }
