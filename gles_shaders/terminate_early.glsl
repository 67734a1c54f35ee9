bool terminated(float alpha) {
    return alpha > viewport.w;
}
