// The words in which the rules are written that two compilers read: the driver's, for GPUs, and this project's own, for the
// vector units of a processor (shaders/wide.hpp), where a `real` is the same number of several texels. What a
// rule may not use, since texels differ: if and ?: of a texel's own numbers, early returns, swizzles.
#define real float
#define truth bool
#define either(a, b) ((a) || (b))
#define both(a, b) ((a) && (b))
#define pick(condition, a, b) ((condition) ? (a) : (b))
#define GIVE_UP_WHERE(condition) if (condition) discard
#define WHERE_ANY(condition) if (condition)
