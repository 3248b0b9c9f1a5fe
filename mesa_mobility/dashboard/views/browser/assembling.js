// A view made of parts, each of which has `data`, `created`, `computed` and `methods` of its own.

// Vue's own `mixins` do not get through to the page.
function assembled(parts, view) {
  const all = [...parts, view];
  const joined = (key) => Object.assign({}, ...all.map((part) => part[key]));
  return {
    ...view,
    data() {
      return Object.assign({}, ...all.map((part) => (part.data ? part.data.call(this) : {})));
    },
    created() {
      for (const part of all) if (part.created) part.created.call(this);
    },
    computed: joined("computed"),
    methods: joined("methods"),
  };
}
