// cg_last_group.glsl - sums over a load in one dispatch, which the load's last workgroup completes.
//
// Each workgroup writes its own sum and takes a ticket; who takes the last one finds all sums written, adds them in a
// fixed order, and goes on with the total. So it does not matter which workgroup is the last, and none waits for
// another one, which Vulkan would not promise to end.
//
// The includer declares  tickets,  a coherent buffer of one uint per load, which are 0 between dispatches, and declares
// coherent what the last workgroup reads of the others. Workgroups have a power of two of invocations.

shared real sums[gl_WorkGroupSize.x * gl_WorkGroupSize.y];
shared uint ticket;

uint groupsOfLoad() { return gl_NumWorkGroups.x * gl_NumWorkGroups.y; }
uint groupOfLoad() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
uint lanesOfGroup() { return gl_WorkGroupSize.x * gl_WorkGroupSize.y; }

// Every invocation gets the sum of what each of its workgroup has; the order depends on the workgroup's size only.
real sumOverGroup(real value)
{
    uint t = gl_LocalInvocationIndex;
    barrier(); // the last sum has been read
    sums[t] = value;
    for (uint reach = lanesOfGroup() / 2u; reach > 0u; reach /= 2u) {
        barrier();
        if (t < reach) sums[t] += sums[t + reach];
    }
    barrier();
    return sums[0];
}

// Returns, alike for all invocations, whether this is the last workgroup of its load. What lane 0 of the others wrote
// before is visible then.
bool isLastGroup(uint load)
{
    if (gl_LocalInvocationIndex == 0u) {
        memoryBarrierBuffer();
        ticket = atomicAdd(tickets[load], 1u);
    }
    barrier();
    bool last = ticket + 1u == groupsOfLoad();
    if (last) memoryBarrierBuffer();
    if (last && gl_LocalInvocationIndex == 0u) atomicExchange(tickets[load], 0u); // for the next dispatch
    return last;
}
