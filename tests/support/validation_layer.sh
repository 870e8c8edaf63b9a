# Sourced by scripts whose programs run under Vulkan's validation layer, which the environment brings to all their devices.
# It needs a folder $work and the function fail.
checks_synchronization=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT
checks_accesses=VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT,VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT

# layer CHECKS [FLAGS]: separated by commas; what the layer says from now on stands in $work/layer.txt.
layer() {
    rm -f "$work/layer.txt"
    printf 'khronos_validation.%s\n' 'debug_action = VK_DBG_LAYER_ACTION_LOG_MSG' "log_filename = $work/layer.txt" \
        "report_flags = ${2-error,warn,perf}" "enables = $1" >"$work/layer_settings.txt"
    VK_LAYER_SETTINGS_PATH=$work/layer_settings.txt VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation
    export VK_LAYER_SETTINGS_PATH VK_INSTANCE_LAYERS
}

# layer_arrives PROGRAM: its words do, those about plates too: this set of checks dislikes small buffers.
layer_arrives() {
    layer VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT
    "$1" touch sample:sheet --points 1500 --cells 16 --solver lavapipe >/dev/null || fail 'no touch under the validation layer'
    grep -q 'BestPractices-vkAllocateMemory' "$work/layer.txt" || fail 'the validation layer does not see the plates'
    layer "$checks_synchronization,$checks_accesses" info
    "$1" touch sample:sheet --points 1500 --cells 16 --solver lavapipe >/dev/null
    for word in SYNCHRONIZATION_VALIDATION GPU_ASSISTED; do
        grep 'Current Enables' "$work/layer.txt" | grep -q $word || fail "the validation layer does not know $word"
    done
}

# layer_is_silent WHAT
layer_is_silent() {
    { [ -e "$work/layer.txt" ] && [ ! -s "$work/layer.txt" ]; } || { fail "the validation layer, $1:"; head -c 4000 "$work/layer.txt"; }
}
