// Each pixel shows its block. Alpha of the picture.
uniform sampler2D source;
uniform sampler2D picture;
uniform int block;

vec4 sample_at(ivec2 pixel) { return vec4(fetch(source, pixel / block).rgb, fetch(picture, pixel).a); }
