bool terminated(float alpha) {
    return false;
}
