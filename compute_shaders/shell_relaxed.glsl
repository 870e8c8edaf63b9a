// shell_relaxed.glsl - both fields of a node of a shell after its relaxation.
//
// The includer declares  entries,  the coefficients, as floats.

struct ShellNode {
    float w;
    float f;
};

float inverseAt(ShellLayout l, int plane, int i, int j)
{
    return entries[((i + kShellRim) * kShellPlanes + plane) * 2 * l.span + placeOf(l, j)];
}

// The fields before and what changes them: the inverse of the node's own block times what is left of its right sides.
ShellNode relaxed(ShellLayout l, int i, int j, ShellNode before, ShellNode left)
{
    float ww = inverseAt(l, kInverseW, i, j), wf = inverseAt(l, kInverseWF, i, j), ff = inverseAt(l, kInverseF, i, j);
    precise ShellNode after;
    after.w = before.w + (ww * left.w + wf * left.f);
    after.f = before.f + (wf * left.w + ff * left.f);
    return after;
}
