uniform float strength;
uniform vec3 tint;

// Colours carry their alpha: a tint is as strong as the pixel is opaque.
vec4 apply(vec4 color) {
  return vec4(mix(color.rgb, tint * color.a, strength), color.a);
}
