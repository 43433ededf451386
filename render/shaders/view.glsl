// How the surface and its paint look to an eye, whoever draws them.

// Light on bare tissue (x) and on paint (y), 0 to 1, and the cosine between normal and line of sight (z), by place and normal in the
// eye's axes. A head-light, a little from the upper left, so that shape reads.
vec3 head_light(vec3 p, vec3 normal) {
  vec3 n = normalize(normal);
  real facing = -dot(n, normalize(p));
  real lambert = max(dot(n, normalize(vec3(-0.35, 0.45, 1.0))) * pick(facing < 0.0, -1.0, 1.0), 0.0);
  return vec3(0.16 + 0.84 * lambert * (0.45 + 0.55 * abs(facing)), 0.86 + 0.14 * lambert, facing);
}

// The near wall as a glass shell: only its rim, premultiplied.
vec4 glass(real facing) {
  real rim = 1.0 - min(abs(facing), 1.0);
  real alpha = 0.03 + 0.30 * rim * rim * rim;
  return vec4(0.75 * alpha, 0.80 * alpha, 0.86 * alpha, alpha);
}

// Unpainted tissue in warm grey, paint (premultiplied) almost as it was photographed.
vec3 tissue(vec3 paint, real cover, vec2 light) {
  return vec3(0.66, 0.59, 0.54) * (light.x * (1.0 - cover)) + paint * light.y;
}

// Of a pixel that shows something, by how many of its four neighbours show nothing: softer outlines.
real outline_cover(real empty) { return 1.0 - 0.27 * min(empty, 3.0); }
