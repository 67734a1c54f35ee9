bool terminated(float alpha) {
    return false;
}

vec4 closed(vec4 sum) {
    return sum;
}
