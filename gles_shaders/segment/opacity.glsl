// Exact lower bounds become float32 comparisons: a guard well above their rounding, far below a
// voxel.
const float kBelow = 1.0 - 1.0e-5;

/// 1 - exp(-depth). Below 1/32 as a series, whose relative error stays below 1e-7 where the
/// difference would lose its digits; exactly 0 at 0, so an invisible layer changes nothing.
float opacityOfDepth(float depth) {
    precise float d = inOpacity(depth);
    precise float s3 = inOpacity(1.0 / 6.0 - inOpacity(d * (1.0 / 24.0)));
    precise float s2 = inOpacity(0.5 - inOpacity(d * s3));
    precise float series = inOpacity(d * inOpacity(1.0 - inOpacity(d * s2)));
    precise float difference = inOpacity(1.0 - inOpacity(exp(-d)));
    return d < 0.03125 ? series : difference;
}
