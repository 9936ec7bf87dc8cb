// Where a walk continues: nodes that wait, nearest last, and with STACK_SHORT the trail to those that did not fit.
// Host: src/bvh/nodes.rs, which knows how many a tree can make wait.
//
// A short stack is a ring: what is put on a full one takes the place of the node that waits longest. The trail has a digit
// for each level between the root and where the walk is: which of the entered children it went to, and how many are left
// after that one. What is left is known by the digits alone, and all that waits in the ring are the last of it. So when the
// ring is empty and a digit has some left, the walk begins at the root again, goes down by the digits, and puts what is left
// at each level on the ring anew. Nothing is passed over: children are counted and ordered by where the ray enters them,
// which does not depend on what it has hit since; only what lies behind that is left out (after Laine, Restart Trail
// for Stackless BVH Traversal, High Performance Graphics 2010, and Vaidyanathan, Woop and Benthin, Wide BVH Traversal
// with a Short Stack, High Performance Graphics 2019; a digit that has what is left, not what is done, is ours).
#ifndef BVH_STACK_GLSL
#define BVH_STACK_GLSL

#include "bvh_nodes.glsl"

// STACK_IS_ values.
layout(constant_id = 70) const uint STACK = 0;
// Words of a ray's own memory, and of the workgroup's; 1 where there are none.
layout(constant_id = 71) const uint STACK_PRIVATE = 1;
layout(constant_id = 72) const uint STACK_SHARED = 1;
// Invocations of a workgroup.
layout(constant_id = 73) const uint STACK_THREADS = 1;
layout(constant_id = 74) const uint TRAIL_WORDS = 1;

const uint STACK_IS_PRIVATE = 0u;
const uint STACK_IS_SHARED = 1u;
const uint STACK_IS_SHORT = 2u;

uint stack_private[STACK_PRIVATE];
shared uint stack_shared[STACK_SHARED];
// Nodes that wait, and with STACK_IS_SHORT the place after the last of them.
uint stack_count;
uint stack_end;

// Bits of a digit: one half which child, the lower half how many are left.
const uint DIGIT_BITS = NODE_WIDTH;
const uint LEFT_MASK = NODE_WIDTH - 1u;
const uint DIGITS_IN_WORD = 32u / DIGIT_BITS;
const uint ALL_LEFT_MASKS = NODE_WIDTH == 2u ? 0x55555555u : 0x33333333u;

uint trail[TRAIL_WORDS];
// Level of the node to visit next, and the one down to which the trail leads.
uint trail_level;
uint trail_end;

void stack_clear() {
    stack_count = 0u;
    stack_end = 0u;
    trail_level = 0u;
    trail_end = 0u;
}

void stack_put(uint node) {
    if (STACK == STACK_IS_SHORT) {
        stack_private[stack_end % STACK_PRIVATE] = node;
        stack_end++;
        stack_count = min(stack_count + 1u, STACK_PRIVATE);
    } else if (STACK == STACK_IS_SHARED) {
        stack_shared[stack_count * STACK_THREADS + gl_LocalInvocationIndex] = node;
        stack_count++;
    } else {
        stack_private[stack_count] = node;
        stack_count++;
    }
}

// The node that has waited least; there is one.
uint stack_take() {
    stack_count--;
    if (STACK == STACK_IS_SHORT) {
        stack_end--;
        return stack_private[stack_end % STACK_PRIVATE];
    }
    if (STACK == STACK_IS_SHARED) {
        return stack_shared[stack_count * STACK_THREADS + gl_LocalInvocationIndex];
    }
    return stack_private[stack_count];
}

// Goes to the next child at the deepest level above this one that has some left; false: none has.
bool trail_turn() {
    uint word = trail_level / DIGITS_IN_WORD;
    uint left = trail[word] & ALL_LEFT_MASKS & ((1u << (trail_level % DIGITS_IN_WORD * DIGIT_BITS)) - 1u);
    while (left == 0u && word > 0u) {
        word--;
        left = trail[word] & ALL_LEFT_MASKS;
    }
    if (left == 0u) {
        return false;
    }
    uint digit = uint(findMSB(left)) / DIGIT_BITS;
    // One child further, one fewer left.
    trail[word] += LEFT_MASK << (digit * DIGIT_BITS);
    trail_level = word * DIGITS_IN_WORD + digit + 1u;
    return true;
}

// Pushes what waits onto the ring and descends, or turns back.
bool walk_on_by_trail(Entered entered, inout uint node) {
    uint word = trail_level / DIGITS_IN_WORD;
    uint shift = trail_level % DIGITS_IN_WORD * DIGIT_BITS;
    uint child = 0u;
    uint left = max(entered.count, 1u) - 1u;
    if (trail_level < trail_end) {
        uint digit = trail[word] >> shift;
        child = digit >> (DIGIT_BITS / 2u) & LEFT_MASK;
        left = digit & LEFT_MASK;
    } else {
        trail[word] = (trail[word] & ~(((1u << DIGIT_BITS) - 1u) << shift)) | left << shift;
    }
    // Behind the limit by now, where it is not among the first: so is all that is left here.
    if (child < entered.count) {
        for (uint waiting = child + left; waiting > child; waiting--) {
            stack_put(entered.nodes[waiting]);
        }
        node = entered.nodes[child];
        trail_level++;
        return true;
    }
    if (!trail_turn()) {
        return false;
    }
    trail_end = 0u;
    if (stack_count > 0u) {
        node = stack_take();
    } else {
        node = ROOT;
        trail_end = trail_level;
        trail_level = 0u;
    }
    return true;
}

// The node that comes after `node`, whose entered children are these; false: none does.
bool walk_on(Entered entered, inout uint node) {
    if (STACK == STACK_IS_SHORT) {
        return walk_on_by_trail(entered, node);
    }
    if (entered.count > 0u) {
        for (uint waiting = NODE_WIDTH - 1u; waiting > 0u; waiting--) {
            if (waiting < entered.count) {
                stack_put(entered.nodes[waiting]);
            }
        }
        node = entered.nodes.x;
        return true;
    }
    if (stack_count == 0u) {
        return false;
    }
    node = stack_take();
    return true;
}

#endif
