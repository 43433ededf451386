// What the rules know of the scope, the view and the settings. Numbers alone, no textures: the same list is a structure of
// C++ (atlas/paint_uniforms.hpp).
uniform vec4 u_intrinsics;         // fx fy cx cy
uniform real u_coefficients[5];    // of the lens
uniform vec2 u_distortion_centre;  // px
uniform vec4 u_circle;             // of the mask: centre x y, radius, soft edge; px
uniform real u_aspect;             // fx / fy
uniform vec2 u_notch;              // where it is from the centre, pixels made square, unit; 0 0: none

uniform mat3 u_rotation_CM;
uniform vec3 u_translation_CM;
uniform real u_facing;             // +1 seen from outside, -1 from inside
uniform real u_cos_cone, u_far_mm, u_cos_obliquity;
uniform real u_depth_tangent;      // of the pinhole that saw the depth
uniform real u_depth_near, u_depth_far, u_depth_size;  // mm, mm, texels

uniform real u_texel_mm;
uniform vec3 u_light;              // reference mm, power of the vignetting's cosine, light at which nothing is changed
uniform real u_capture;            // its number, 1 to 65535
uniform vec3 u_view_error;         // mm, rad, pixels
uniform real u_pixel_rad;          // angle of one pixel at the centre
uniform vec2 u_picture_size;       // px
