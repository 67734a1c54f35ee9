/// 1 - 2^-halvings. Small ones by a series: its relative error stays below 1.3e-6, and is least where
/// the difference loses its digits. Exactly 0 at 0, so an invisible layer changes nothing.
float opacityOf(float halvings) {
    precise float h = inOpacity(halvings);
    // ln 2, (ln 2)^2 / 2, (ln 2)^3 / 6
    precise float s2 = inOpacity(fma(h, -5.5504109e-2, 0.24022651));
    precise float s1 = inOpacity(fma(h, -s2, 0.69314718));
    precise float series = inOpacity(h * s1);
    precise float difference = inOpacity(1.0 - inOpacity(exp2(-h)));
    return h < 0.045 ? series : difference;
}
