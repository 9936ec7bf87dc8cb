// Lists in the order of their ids: the links themselves are sorted, by merging runs of 1, 2, 4 and so on, so that a list of a
// thousand takes n log n steps and no memory; nearly all have one or two.
//
// The including shader declares node_of and set_next of reach.glsl.
#ifndef DEEP_SHADING_SORTED_GLSL
#define DEEP_SHADING_SORTED_GLSL

// `list`: a pointer to its first node, not 0. Returns that of the sorted one.
uint sorted(uint list) {
    for (uint run = 1u;; run *= 2u) {
        uint rest = list;
        uint tail = 0u;
        uint merge_count = 0u;
        list = 0u;
        while (rest != 0u) {
            merge_count++;
            uint left = rest;
            uint left_count = 0u;
            while (left_count < run && rest != 0u) {
                left_count++;
                rest = node_of(rest - 1u).y;
            }
            uint right = rest;
            uint right_count = run;
            while (left_count > 0u || (right_count > 0u && right != 0u)) {
                bool takes_left = left_count > 0u;
                if (takes_left && right_count > 0u && right != 0u) {
                    takes_left = node_of(left - 1u).x <= node_of(right - 1u).x;
                }
                uint next = takes_left ? left : right;
                if (takes_left) {
                    left = node_of(left - 1u).y;
                    left_count--;
                } else {
                    right = node_of(right - 1u).y;
                    right_count--;
                }
                if (tail == 0u) {
                    list = next;
                } else {
                    set_next(tail - 1u, next);
                }
                tail = next;
            }
            rest = right;
        }
        set_next(tail - 1u, 0u);
        if (merge_count <= 1u) {
            return list;
        }
    }
}

#endif
