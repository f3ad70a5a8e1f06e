vec4 apply(vec4 color) { return color; }
